#include "analysis/hard_rays.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "analysis/ray_targets.h"
#include "builders/leaves.h"

namespace coppice {
namespace {

using glm::dvec3;

constexpr float INFINITE = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

Ray ray_from(const vec3& origin, const vec3& direction) { return {origin, 0.0f, direction, INFINITE}; }

Ray ray_at(const RayTargets& targets, const Triangle& triangle, const dvec3& target, DoubleRandom& random) {
  const vec3 origin = targets.origin(triangle, random);
  return ray_from(origin, aim(origin, target, random));
}

// A ray that passes exactly through the point at t = 1: between 0 and the point lie multiples of the point's
// last place, and those and their distances from it are floats.
Ray ray_exactly_through(const vec3& point, const RayTargets& targets, DoubleRandom& random) {
  vec3 origin, direction;
  for (int axis = 0; axis < 3; ++axis) {
    const float x = point[axis];
    if (x == 0.0f) {
      origin[axis] = static_cast<float>(targets.size() * random.uniform(-1, 1));
      direction[axis] = -origin[axis];
      continue;
    }
    const float place = std::ldexp(1.0f, std::max(std::ilogb(x) - 23, -149));
    const double count = std::floor(std::abs(double{x}) / place * random.uniform());
    origin[axis] = std::copysign(static_cast<float>(count * place), x);
    direction[axis] = x - origin[axis];
  }
  return ray_from(origin, direction);
}

Ray at_vertex(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const dvec3 corner = corner_of(triangle, random);
  if (random.coin()) return ray_exactly_through(vec3(corner), targets, random);
  return ray_at(targets, triangle, corner, random);
}

Ray at_edge(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const dvec3 point = edge_point_of(triangle, random);
  if (random.coin() && dvec3(vec3(point)) == point) return ray_exactly_through(vec3(point), targets, random);
  return ray_at(targets, triangle, point, random);
}

// Collinear with an edge but for rounding, from before, on or behind it.
Ray along_edge(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const vec3 corners[] = {triangle.a, triangle.b, triangle.c};
  const std::uint32_t first = random.below(3);
  const dvec3 start(corners[first]), end(corners[(first + 1) % 3]);
  const double share = random.below(4) == 0 ? 0.0 : random.uniform(-2, 1);
  const vec3 origin = to_float(start + share * (end - start));
  return ray_from(origin, aim(origin, end, random));
}

Ray in_plane(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const dvec3 a(triangle.a), to_b = dvec3(triangle.b) - a, to_c = dvec3(triangle.c) - a;
  const double u = random.uniform(-2, 3), v = random.uniform(-2, 3);
  const vec3 origin = to_float(a + u * to_b + v * to_c);
  return ray_from(origin, aim(origin, inner_point_of(triangle, random), random));
}

vec3 point_in(const Aabb& box, DoubleRandom& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return to_float(glm::mix(dvec3(box.box_min), dvec3(box.box_max), dvec3(x, y, z)));
}

float zero_of(DoubleRandom& random) { return random.coin() ? 0.0f : -0.0f; }

Ray in_box_face(const RayTargets& targets, DoubleRandom& random) {
  const Aabb box = targets.box(random);
  const vec3 target = point_in(box, random);
  vec3 origin = to_float(dvec3(target) + 2 * targets.size() * random.in_cube());
  if (random.coin()) origin = point_in(box, random);
  const int axis = static_cast<int>(random.below(3));
  origin[axis] = random.coin() ? box.box_min[axis] : box.box_max[axis];
  vec3 direction = aim(origin, dvec3(target), random);
  direction[axis] = zero_of(random);
  return ray_from(origin, direction);
}

Ray from_surface(const RayTargets& targets, DoubleRandom& random) {
  const vec3 origin = to_float(inner_point_of(targets.triangle(random), random));
  return ray_from(origin, vec3(random.direction()));
}

Ray from_box_corner(const RayTargets& targets, DoubleRandom& random) {
  const Aabb box = targets.box(random);
  vec3 origin, opposite;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_low = random.coin();
    origin[axis] = is_low ? box.box_min[axis] : box.box_max[axis];
    opposite[axis] = is_low ? box.box_max[axis] : box.box_min[axis];
  }
  switch (random.below(3)) {
    case 0:
      return ray_from(origin, aim(origin, dvec3(opposite), random));
    case 1:
      return ray_from(origin, aim(origin, dvec3(point_in(box, random)), random));
    default:
      return ray_from(origin, vec3(random.direction()));
  }
}

// Along an axis, or in a plane of two axes.
Ray axis_parallel(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const dvec3 target = random.coin() ? inner_point_of(triangle, random) : corner_of(triangle, random);
  const int axis = static_cast<int>(random.below(3));
  const bool is_along = random.coin();
  vec3 origin = targets.origin(triangle, random);
  for (int other = 0; other < 3; ++other) {
    if ((other == axis) != is_along) origin[other] = static_cast<float>(target[other]);
  }
  vec3 direction = aim(origin, target, random);
  for (int other = 0; other < 3; ++other) {
    if ((other == axis) != is_along) direction[other] = zero_of(random);
  }
  return ray_from(origin, direction);
}

Ray at_inside(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  return ray_at(targets, triangle, inner_point_of(triangle, random), random);
}

Ray non_finite(const RayTargets& targets, DoubleRandom& random) {
  Ray ray = at_inside(targets, random);
  const float value = std::array{NOT_A_NUMBER, INFINITE, -INFINITE}[random.below(3)];
  const int axis = static_cast<int>(random.below(3));
  switch (random.below(4)) {
    case 0:
      ray.origin[axis] = value;
      break;
    case 1:
      ray.direction[axis] = value;
      break;
    case 2:
      ray.direction = random.coin() ? vec3(zero_of(random)) : vec3(value);
      break;
    default:
      (random.coin() ? ray.t_min : ray.t_max) = NOT_A_NUMBER;
  }
  return ray;
}

// One, two or all direction components so small that they count as 0; the rest is what it was or is just
// above.
Ray denormal(const RayTargets& targets, DoubleRandom& random) {
  Ray ray = axis_parallel(targets, random);
  const std::uint32_t count = 1 + random.below(3), first = random.below(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    float& component = ray.direction[static_cast<int>((first + i) % 3)];
    const double size = i < count ? FLT_MIN * random.uniform() : FLT_MIN * random.uniform(1, 8);
    if (i < count || random.below(4) == 0) {
      component = std::copysign(static_cast<float>(size), component);
    }
  }
  return ray;
}

// Ends of the range at, beside and around a point of a triangle.
Ray with_range(const RayTargets& targets, DoubleRandom& random) {
  const Triangle& triangle = targets.triangle(random);
  const dvec3 target = inner_point_of(triangle, random);
  Ray ray = ray_at(targets, triangle, target, random);
  const dvec3 direction(ray.direction);
  const double distance =
      glm::dot(target - dvec3(ray.origin), direction) / std::max(glm::dot(direction, direction), 1e-300);
  const auto t = static_cast<float>(std::clamp(distance, 0.0, double{FLT_MAX}));
  const float before = std::max(0.0f, std::nextafter(t, -INFINITE)), behind = std::nextafter(t, INFINITE);
  const std::array<std::array<float, 2>, 12> ranges = {{{t, t},
                                                        {0, t},
                                                        {t, INFINITE},
                                                        {0, before},
                                                        {behind, INFINITE},
                                                        {before, behind},
                                                        {0.5f * t, 0.9f * t},
                                                        {behind, before},
                                                        {0, -1},
                                                        {INFINITE, INFINITE},
                                                        {INFINITE, 0},
                                                        {0, FLT_MIN}}};
  const std::array<float, 2> range = ranges[random.below(ranges.size())];
  ray.t_min = range[0];
  ray.t_max = range[1];
  return ray;
}

Ray from_afar(const RayTargets& targets, DoubleRandom& random) {
  const vec3 origin = to_float(targets.centre() + 1e7 * targets.size() * random.direction());
  return ray_from(origin, aim(origin, inner_point_of(targets.triangle(random), random), random));
}

Ray of_odd_length(const RayTargets& targets, DoubleRandom& random) {
  Ray ray = at_inside(targets, random);
  const dvec3 unit = glm::normalize(dvec3(ray.direction));
  ray.direction = vec3(unit * (random.coin() ? 1e30 : 1e-30));
  return ray;
}

Ray at_random(const RayTargets& targets, DoubleRandom& random) {
  const vec3 origin = to_float(targets.centre() + 2 * targets.size() * random.in_cube());
  const dvec3 target = targets.centre() + targets.size() * random.in_cube();
  return ray_from(origin, aim(origin, target, random));
}

using MakeRay = Ray (*)(const RayTargets& targets, DoubleRandom& random);

constexpr std::array RAY_KINDS = std::to_array<RayKindName>({
    {RayKind::VERTICES, "vertices", "through corners, half of them exactly"},
    {RayKind::EDGES, "edges", "through points of edges, some of them exactly"},
    {RayKind::ALONG_EDGES, "along-edges", "along an edge, from before or on it"},
    {RayKind::IN_PLANES, "in-planes", "in the plane of a triangle, from outside or inside of it"},
    {RayKind::IN_BOX_FACES, "in-box-faces", "in the plane of a box of the tree"},
    {RayKind::FROM_SURFACES, "from-surfaces", "from a point on a triangle, to either side"},
    {RayKind::FROM_BOX_CORNERS, "from-box-corners", "from the corner of a box of the tree"},
    {RayKind::AXIS_PARALLEL, "axis-parallel", "one or two direction components 0 or -0"},
    {RayKind::NON_FINITE, "non-finite", "a NaN, an infinity or the direction 0: nothing to hit"},
    {RayKind::DENORMAL, "denormal", "direction components that are denormal or just above"},
    {RayKind::RANGES, "ranges", "ranges of t that are empty, reversed, tiny or end at a hit"},
    {RayKind::FAR_ORIGINS, "far-origins", "from 10^7 scene sizes away"},
    {RayKind::LENGTHS, "lengths", "directions of length 1e-30 and 1e30"},
    {RayKind::RANDOM, "random", "from around the scene into it"},
});

MakeRay maker_of(RayKind kind) {
  switch (kind) {
    case RayKind::VERTICES:
      return at_vertex;
    case RayKind::EDGES:
      return at_edge;
    case RayKind::ALONG_EDGES:
      return along_edge;
    case RayKind::IN_PLANES:
      return in_plane;
    case RayKind::IN_BOX_FACES:
      return in_box_face;
    case RayKind::FROM_SURFACES:
      return from_surface;
    case RayKind::FROM_BOX_CORNERS:
      return from_box_corner;
    case RayKind::AXIS_PARALLEL:
      return axis_parallel;
    case RayKind::NON_FINITE:
      return non_finite;
    case RayKind::DENORMAL:
      return denormal;
    case RayKind::RANGES:
      return with_range;
    case RayKind::FAR_ORIGINS:
      return from_afar;
    case RayKind::LENGTHS:
      return of_odd_length;
    case RayKind::RANDOM:
      break;
  }
  return at_random;
}

}  // namespace

std::span<const RayKindName> ray_kinds() { return RAY_KINDS; }

std::vector<Ray> hard_rays(RayKind kind, std::span<const Triangle> triangles, std::span<const Node> nodes,
                           std::uint32_t count, std::uint64_t seed) {
  const RayTargets targets(triangles, nodes);
  DoubleRandom random(seed);
  std::vector<Ray> rays(count);
  std::ranges::generate(rays, [&] { return maker_of(kind)(targets, random); });
  return rays;
}

std::vector<Ray> inside_rays(const vec3& point, std::span<const Triangle> triangles, std::uint32_t count,
                             std::uint64_t seed) {
  if (std::ranges::none_of(triangles, is_active)) return {};
  const RayTargets targets(triangles, {});
  DoubleRandom random(seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle& triangle = targets.triangle(random);
    const dvec3 target = i % 3 == 0   ? corner_of(triangle, random)
                         : i % 3 == 1 ? edge_point_of(triangle, random)
                                      : inner_point_of(triangle, random);
    rays.push_back(ray_from(point, aim(point, target, random)));
  }
  return rays;
}

}  // namespace coppice
