#pragma once

#include <array>

#include "interface/refit.h"
#include "twins/normalised.h"

namespace coppice::twins {

// Half areas in the root's normalised coordinates, times TREE_AREAS_SCALE.
class TreeArea {
 public:
  explicit TreeArea(const Node& root);
  float operator()(const Node& node) const;

 private:
  Normalisation normalise_;
};

// The parts of the invocations of a workgroup, added up as it does: the upper half to the lower one.
float group_sum(std::array<float, TREE_AREAS_GROUP> parts);

}  // namespace coppice::twins
