#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "interface/trace.h"

namespace coppice {

// Rays that are hard on an intersection test or a traversal, by what is hard about them.
enum class RayKind {
  VERTICES,
  EDGES,
  ALONG_EDGES,
  IN_PLANES,
  IN_BOX_FACES,
  FROM_SURFACES,
  FROM_BOX_CORNERS,
  AXIS_PARALLEL,
  NON_FINITE,
  DENORMAL,
  RANGES,
  FAR_ORIGINS,
  LENGTHS,
  RANDOM,
};

struct RayKindName {
  RayKind kind;
  std::string_view name;         // words joined by hyphens
  std::string_view description;  // one line
};

// All kinds, in the order in which they are listed to the user.
std::span<const RayKindName> ray_kinds();

// `count` rays of that kind at the active triangles and at the boxes of the nodes (of the triangles, where
// `nodes` is empty). Pure: the same arguments give the same bits. Directions are computed in double and then
// rounded to float. t_min is never negative except in reversed ranges. Unless the kind says otherwise all is
// finite but t_max, which is infinite. Without an active triangle the rays are aimed at the unit cube.
std::vector<Ray> hard_rays(RayKind kind, std::span<const Triangle> triangles, std::span<const Node> nodes,
                           std::uint32_t count, std::uint64_t seed);

// `count` rays from a point, by turns at corners, at points of edges and at points inside of triangles that
// are active, t from 0 to infinity. Where the triangles close a volume around the point each must hit. Empty
// where no triangle is active.
std::vector<Ray> inside_rays(const vec3& point, std::span<const Triangle> triangles, std::uint32_t count,
                             std::uint64_t seed);

}  // namespace coppice
