#pragma once

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_double3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/exact_hit.h"

namespace coppice {

// Half a unit in the last place of 1 in double: a single rounding.
inline constexpr double ROUNDING_OF_DOUBLE = 0x1p-53;

// Relative room around boxes: they are exact for whole triangles, but the parts of split ones are rounded.
inline constexpr double BOX_ROOM = 0x1p-40;

// The part of a line within a box or a triangle, with everything that rounding may have cut off.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_empty() const { return !(low <= high); }
};

// A ray that can hit (can_hit), in double. Denormal components of the direction are 0.
class ExactLine {
 public:
  explicit ExactLine(const Ray& ray);

  // Contains every t at which the line is in the box.
  Interval clip(const vec3& box_min, const vec3& box_max) const;

  Ray ray;
  glm::dvec3 origin, direction, reciprocal;
};

// A triangle that the line meets.
struct Candidate {
  std::uint32_t triangle;
  Interval t;     // contains the exact t
  bool in_range;  // exactly
};

// Decided in double where the error bounds allow it, else exactly. None where the line does not meet the
// triangle. Beyond t = `exact_limit` there may also be none where double does not decide, which is never so
// where the line is clearly inside (judge_hits.h).
std::optional<Candidate> find_candidate(const ExactLine& line, std::span<const Triangle> triangles,
                                        std::uint32_t triangle, double exact_limit);

// Keeps the closest candidate in range, of equally close ones the one with the smallest index.
class ClosestCandidate {
 public:
  ClosestCandidate(const ExactLine& line, std::span<const Triangle> triangles)
      : line_(line), triangles_(triangles) {}

  void offer(const Candidate& candidate);
  const std::optional<Candidate>& best() const { return best_; }

 private:
  const ExactLine& line_;
  std::span<const Triangle> triangles_;
  std::optional<Candidate> best_;
};

// A node whose box the line meets, and where it enters.
struct WalkEntry {
  std::uint32_t node;
  double low;
};

// Calls visit(triangle index) for at least all triangles that the line meets at a t in [t_min, limit()] of
// the ray, nearer boxes first. limit() may fall as triangles are visited. `stack` is only memory to be used
// again.
template <class Limit, class Visit>
void walk_triangles(std::span<const Node> nodes, std::span<const Triangle> triangles, const ExactLine& line,
                    std::vector<WalkEntry>& stack, const Limit& limit, const Visit& visit) {
  if (nodes.empty()) {
    for (std::size_t i = 0; i < triangles.size(); ++i) visit(static_cast<std::uint32_t>(i));
    return;
  }
  stack.assign(1, {0, -std::numeric_limits<double>::infinity()});
  while (!stack.empty()) {
    const WalkEntry entry = stack.back();
    stack.pop_back();
    if (entry.low > limit()) continue;
    const Node& node = nodes[entry.node];
    if (node.height == 0) {
      visit(node.child);
      continue;
    }
    const std::size_t first = stack.size();
    for (const std::uint32_t child : {node.child, node.child + 1}) {
      const Interval inside = line.clip(nodes[child].box_min, nodes[child].box_max);
      if (inside.is_empty() || inside.high < line.ray.t_min || inside.low > limit()) continue;
      stack.push_back({child, inside.low});
    }
    if (stack.size() == first + 2 && stack[first].low < stack[first + 1].low) {
      std::swap(stack[first], stack[first + 1]);
    }
  }
}

}  // namespace coppice
