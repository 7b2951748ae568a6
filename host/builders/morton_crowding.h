#pragma once

#include <cstdint>
#include <span>

#include "interface/types.h"

namespace coppice {

// How many other triangles share the cell of an active triangle drawn at random, on average, where the Morton
// grid has 30 bits and where it has 60.
//
// PLOC looks for neighbours within its search radius along the Morton order, and triangles of equal codes
// stand in the order of the file. In a cell of many more triangles than the radius the search sees an
// arbitrary few of them, unless the file is in good order: the "teapot in a stadium" (E. Haines, "Spline
// Surface Rendering, and What's Wrong with Octrees", Ray Tracing News, 1988).
struct MortonCrowding {
  double with_30_bits = 0, with_60_bits = 0;
};

// Exact up to CROWDING_SAMPLES triangles. Of more, that many are drawn, by fixed numbers that look random,
// and their pairs are counted (docs/numerics.md, Morton grid). Codes and grid are those of
// make_morton_leaves. Runs on all threads, whose number does not change the result. At most 2^31 triangles.
inline constexpr std::uint32_t CROWDING_SAMPLES = 1 << 14;
MortonCrowding morton_crowding(std::span<const Triangle> triangles);

// 60 where codes of 60 bits take more than CROWDING_LIMIT triangles out of a triangle's cell, else 30: also
// where cells are crowded either way, since nothing is gained on centres that coincide. Where
// as many triangles as the limit stand in a cell in random order, the SAH cost of the tree over the cell is
// about three times what it is with 60 bits. Ordinary scenes stay below and are not worth a sort of twice the
// keys.
inline constexpr double CROWDING_LIMIT = 2048;
std::uint32_t choose_morton_bits(std::span<const Triangle> triangles);

}  // namespace coppice
