#pragma once

#include <span>

#include "builders/bvh.h"

namespace coppice {

// Splits in two at the middle of the longest axis of the node's box, by the centre of each triangle's box,
// from the root to single triangles: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986, with the spatial
// median in place of the object median. Centres on the plane go to the upper side; of equally long axes the
// first is taken.
//
// Where the plane leaves one side empty, as it must where all centres coincide, the list is split in its
// middle as it stands, and also where the tree would become higher than SPLIT_HEIGHT_LIMIT. Sequential.
// Triangles with a non-finite coordinate are left out. Throws std::length_error for more than 2^31 triangles.
Bvh build_top_down(std::span<const Triangle> triangles);

}  // namespace coppice
