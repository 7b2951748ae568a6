#pragma once

#include <span>

#include "builders/bvh.h"

namespace coppice {

// Full-sweep SAH, the yardstick of quality for object splits: MacDonald and Booth, "Heuristics for Ray
// Tracing using Space Subdivision", 1990, with every split between two neighbours in the order of the centres
// of the triangles' boxes tried, as in Wald, Boulos and Shirley, "Ray Tracing Deformable Scenes using Dynamic
// Bounding Volume Hierarchies", 2007. The split where A(first) * count(first) + A(second) * count(second) is
// least wins (equation 1 with C_i = C_l = 1); of equal costs the first axis, then the smaller first part.
// Sorts once along each axis and keeps the three orders through all splits.
//
// Where all centres coincide the list is split in its middle, and also where the tree would become higher
// than SPLIT_HEIGHT_LIMIT. Sequential. Triangles with a non-finite coordinate are left out. Throws
// std::length_error for more than 2^31 triangles.
Bvh build_sah_sweep(std::span<const Triangle> triangles);

}  // namespace coppice
