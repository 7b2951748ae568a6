#include "analysis/cpu_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace coppice {
namespace {

using glm::dvec3;

// Relative and, near the ray's origin, absolute room for the rounding of distances: some hundred units in the
// last place of a double, and still far less than one of a float.
constexpr double ROUNDING = 0x1p-44;

struct SlabInterval {
  double near, far;
  bool is_empty() const { return !(near <= far); }
};

// A ray, or none where `is_valid` is false.
class PreparedRay {
 public:
  explicit PreparedRay(const Ray& ray) : origin(ray.origin), t_min(ray.t_min), t_max(ray.t_max) {
    is_valid = t_min <= t_max;
    bool has_direction = false;
    for (int axis = 0; axis < 3; ++axis) {
      is_valid &= std::isfinite(ray.origin[axis]) && std::isfinite(ray.direction[axis]);
      const bool counts = std::abs(ray.direction[axis]) >= FLT_MIN;
      has_direction |= counts;
      direction[axis] = counts ? ray.direction[axis] : 0.0f;
      reciprocal[axis] = 1.0 / direction[axis];
    }
    is_valid &= has_direction;
  }

  // The part of the line inside of a box, a little enlarged. Monotonic: a larger box never has a smaller
  // part.
  SlabInterval clip(const vec3& box_min, const vec3& box_max) const {
    SlabInterval inside{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box_min[axis] - origin[axis];
      const double high = box_max[axis] - origin[axis];
      const double room = ROUNDING * std::max({std::abs(low), std::abs(high), std::abs(origin[axis])});
      if (direction[axis] == 0.0) {
        if (low - room > 0.0 || high + room < 0.0) return {1.0, 0.0};
        continue;
      }
      const double t0 = (low - room) * reciprocal[axis];
      const double t1 = (high + room) * reciprocal[axis];
      inside.near = std::max(inside.near, std::min(t0, t1));
      inside.far = std::min(inside.far, std::max(t0, t1));
    }
    return inside;
  }

  dvec3 origin;
  dvec3 direction;
  dvec3 reciprocal;
  float t_min;
  float t_max;
  bool is_valid;
};

// `passes` takes the hit of a ray that it knows.
template <class Passes>
void test_triangle(std::span<const Triangle> triangles, std::uint32_t index, const PreparedRay& ray,
                   const Passes& passes, Hit& best) {
  const Triangle& triangle = triangles[index];
  for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y) || !std::isfinite(corner.z)) return;
  }
  const SlabInterval inside = ray.clip(glm::min(glm::min(triangle.a, triangle.b), triangle.c),
                                       glm::max(glm::max(triangle.a, triangle.b), triangle.c));
  if (inside.is_empty()) return;

  const dvec3 a = dvec3(triangle.a) - ray.origin;
  const dvec3 b = dvec3(triangle.b) - ray.origin;
  const dvec3 c = dvec3(triangle.c) - ray.origin;
  // On which side of each edge the line passes. An edge gives its two triangles the same number but for the
  // sign, bit for bit, since the cross product is antisymmetric in floating point too.
  const double beside_bc = glm::dot(ray.direction, glm::cross(b, c));
  const double beside_ca = glm::dot(ray.direction, glm::cross(c, a));
  const double beside_ab = glm::dot(ray.direction, glm::cross(a, b));
  const bool all_left = beside_bc >= 0.0 && beside_ca >= 0.0 && beside_ab >= 0.0;
  const bool all_right = beside_bc <= 0.0 && beside_ca <= 0.0 && beside_ab <= 0.0;
  if (!all_left && !all_right) return;

  const dvec3 normal =
      glm::cross(dvec3(triangle.b) - dvec3(triangle.a), dvec3(triangle.c) - dvec3(triangle.a));
  const double slope = glm::dot(ray.direction, normal);
  const double sum = beside_bc + beside_ca + beside_ab;
  if (slope == 0.0 || sum == 0.0) return;
  const double distance = glm::dot(a, normal) / slope;
  // A line almost in the triangle's plane: the quotient may be noise, but the hit is inside of the box.
  const float t = static_cast<float>(std::clamp(distance, inside.near, inside.far));
  if (!(t >= ray.t_min && t <= ray.t_max && std::isfinite(t))) return;
  if (t < best.t || (t == best.t && index < best.triangle)) {
    const Hit hit{t, index, static_cast<float>(beside_ca / sum), static_cast<float>(beside_ab / sum)};
    if (!passes(hit)) best = hit;
  }
}

Hit miss_of(const Ray& ray) { return {ray.t_max, NO_TRIANGLE, 0.0f, 0.0f}; }

// A node whose box the ray meets, and where it enters.
struct Entry {
  std::uint32_t node;
  float near;
};

void push_children(const Node& parent, std::span<const Node> nodes, const PreparedRay& ray,
                   std::vector<Entry>& stack) {
  const std::size_t first = stack.size();
  for (const std::uint32_t child : {parent.child, parent.child + 1}) {
    const SlabInterval inside = ray.clip(nodes[child].box_min, nodes[child].box_max);
    // Compared in float, as distances are: a triangle's is clamped to its box before it is rounded.
    if (inside.is_empty() || static_cast<float>(inside.far) < ray.t_min) continue;
    stack.push_back({child, static_cast<float>(inside.near)});
  }
  // The nearer child last, so that it comes next.
  if (stack.size() == first + 2 && stack[first].near < stack[first + 1].near) {
    std::swap(stack[first], stack[first + 1]);
  }
}

template <class Passes>
Hit closest_hit(std::span<const Node> nodes, std::span<const Triangle> triangles, const Ray& ray,
                const Passes& passes, std::vector<Entry>& stack) {
  Hit best = miss_of(ray);
  const PreparedRay prepared(ray);
  if (nodes.empty() || !prepared.is_valid) return best;
  stack.assign(1, {0, -std::numeric_limits<float>::infinity()});
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    // A box as close as the best hit may hold a tie.
    if (entry.near > best.t) continue;
    const Node& node = nodes[entry.node];
    if (node.height == 0) {
      test_triangle(triangles, node.child, prepared, passes, best);
    } else {
      push_children(node, nodes, prepared, stack);
    }
  }
  return best;
}

template <class Passes>
Hit brute_force_hit(std::span<const Triangle> triangles, const Ray& ray, const Passes& passes) {
  Hit best = miss_of(ray);
  const PreparedRay prepared(ray);
  if (!prepared.is_valid) return best;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    test_triangle(triangles, static_cast<std::uint32_t>(i), prepared, passes, best);
  return best;
}

bool passes_none(const Hit&) { return false; }

}  // namespace

Hit closest_hit(std::span<const Node> nodes, std::span<const Triangle> triangles, const Ray& ray) {
  std::vector<Entry> stack;
  return closest_hit(nodes, triangles, ray, passes_none, stack);
}

Hit brute_force_hit(std::span<const Triangle> triangles, const Ray& ray) {
  return brute_force_hit(triangles, ray, passes_none);
}

void trace_all(std::span<const Node> nodes, std::span<const Triangle> triangles, std::span<const Ray> rays,
               std::span<Hit> hits, const PassedHits& passes) {
  if (rays.size() != hits.size()) throw std::invalid_argument("trace_all: as many hits as rays are needed");
  const auto trace = [&](const Ray& ray, const auto& passes_hit, std::vector<Entry>& stack) {
    return nodes.empty() ? brute_force_hit(triangles, ray, passes_hit)
                         : closest_hit(nodes, triangles, ray, passes_hit, stack);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    std::vector<Entry> stack;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      hits[i] = passes ? trace(
                             rays[i], [&](const Hit& hit) { return passes(i, hit); }, stack)
                       : trace(rays[i], passes_none, stack);
    }
  });
}

}  // namespace coppice
