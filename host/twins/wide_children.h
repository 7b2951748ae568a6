#pragma once

#include <vector>

#include "twins/wide_distances.h"

namespace coppice::twins {

// A child of a wide node that a ray meets.
struct WideChildVisit {
  uint kept;  // bits of the distance
  uint word;  // of the child
};

// The children that the ray meets up to `limit`, the nearest last, as a stack has them.
std::vector<WideChildVisit> met_children(const WideNode& node, const WideDistances& distances, float limit);

}  // namespace coppice::twins
