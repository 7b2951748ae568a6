#include "analysis/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "interface/refit.h"

namespace coppice {
namespace {

using Fault = std::optional<std::string>;

// Corners of a triangle that lie in the box of one of its leaves, a bit each.
constexpr std::uint8_t ALL_CORNERS = 7;

bool contains(const Node& node, const vec3& point) {
  return glm::all(glm::lessThanEqual(node.box_min, point)) &&
         glm::all(glm::lessThanEqual(point, node.box_max));
}

bool contains(const Node& outer, const Node& inner) {
  return contains(outer, inner.box_min) && contains(outer, inner.box_max);
}

bool is_finite(const Triangle& triangle) {
  for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y) || !std::isfinite(corner.z)) return false;
  }
  return true;
}

bool is_nothing(const Node& node) {
  return node.box_min == vec3(NOTHING_BOX) && node.box_max == vec3(-NOTHING_BOX);
}

std::string node_name(std::size_t node) { return "node " + std::to_string(node); }
std::string triangle_name(std::size_t index) { return "triangle " + std::to_string(index); }

class TreeValidation {
 public:
  TreeValidation(std::span<const Node> nodes, std::span<const Triangle> triangles,
                 const TreePromises& promises)
      : nodes_(nodes),
        triangles_(triangles),
        promises_(promises),
        reached_(nodes.size(), 0),
        leaves_(triangles.size(), 0),
        corners_(triangles.size(), 0) {}

  Fault find() {
    if (nodes_.empty()) return find_in_triangles();
    if (Fault fault = find_in_nodes()) return fault;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!reached_[i]) return node_name(i) + " is not reached from the root";
    }
    if (Fault fault = find_in_triangles()) return fault;
    if (nodes_.size() != 2 * leaf_count_ - 1) {
      return std::to_string(nodes_.size()) + " nodes for " + std::to_string(leaf_count_) + " leaves";
    }
    return {};
  }

 private:
  Fault find_in_nodes() {
    std::vector<std::uint32_t> stack = {0};
    reached_[0] = 1;
    while (!stack.empty()) {
      const std::uint32_t index = stack.back();
      stack.pop_back();
      const Node& node = nodes_[index];
      // Not `box_min > box_max`: a NaN must fail too.
      const bool is_box = glm::all(glm::lessThanEqual(node.box_min, node.box_max));
      if (!is_box && !(promises_.refitted && is_nothing(node))) {
        return node_name(index) + " has a box with a NaN or with box_min > box_max";
      }
      if (node.height == 0) {
        if (Fault fault = find_in_leaf(index)) return fault;
        continue;
      }
      if (node.child >= nodes_.size() - 1) {
        return node_name(index) + " has a child index out of range: " + std::to_string(node.child);
      }
      for (const std::uint32_t child : {node.child + 1, node.child}) {
        if (reached_[child])
          return node_name(child) + " is reached twice, the second time from " + node_name(index);
        reached_[child] = 1;
        stack.push_back(child);
      }
      if (Fault fault = find_in_children(index)) return fault;
    }
    return {};
  }

  Fault find_in_leaf(std::uint32_t index) {
    const Node& node = nodes_[index];
    if (node.child >= triangles_.size()) {
      return node_name(index) + " holds triangle " + std::to_string(node.child) + " of " +
             std::to_string(triangles_.size());
    }
    const Triangle& triangle = triangles_[node.child];
    if (++leaves_[node.child] > 1 && !promises_.splits_triangles) {
      return triangle_name(node.child) + " is in more than one leaf";
    }
    if (is_finite(triangle) ? is_nothing(node) : !promises_.refitted)
      return node_name(index) + (is_nothing(node) ? " has no box for " : " holds inactive ") +
             triangle_name(node.child);
    ++leaf_count_;
    return is_finite(triangle) ? find_in_corners(index) : find_in_nothing(index);
  }

  Fault find_in_nothing(std::uint32_t index) const {
    if (is_nothing(nodes_[index])) return {};
    return node_name(index) + " has a box for inactive " + triangle_name(nodes_[index].child);
  }

  Fault find_in_corners(std::uint32_t index) {
    const Node& node = nodes_[index];
    const Triangle& triangle = triangles_[node.child];
    const std::array<vec3, 3> corners = {triangle.a, triangle.b, triangle.c};
    for (int i = 0; i < 3; ++i) {
      if (contains(node, corners[i])) corners_[node.child] |= 1 << i;
    }
    if (!promises_.splits_triangles) {
      if (corners_[node.child] != ALL_CORNERS) {
        return node_name(index) + " has a box that does not contain " + triangle_name(node.child);
      }
      const vec3 box_min = glm::min(glm::min(triangle.a, triangle.b), triangle.c);
      const vec3 box_max = glm::max(glm::max(triangle.a, triangle.b), triangle.c);
      if (promises_.tight_boxes && (node.box_min != box_min || node.box_max != box_max)) {
        return node_name(index) + " has a box larger than that of " + triangle_name(node.child);
      }
    }
    return {};
  }

  Fault find_in_children(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const Node& first = nodes_[node.child];
    const Node& second = nodes_[node.child + 1];
    if (node.height != 1 + std::uint64_t{std::max(first.height, second.height)}) {
      return node_name(index) + " has height " + std::to_string(node.height) + " above heights " +
             std::to_string(first.height) + " and " + std::to_string(second.height);
    }
    for (const std::uint32_t child : {node.child, node.child + 1}) {
      if (!contains(node, nodes_[child]) && !is_nothing(nodes_[child])) {
        return node_name(index) + " has a box that does not contain that of its child, " + node_name(child);
      }
    }
    if (promises_.tight_boxes && (node.box_min != glm::min(first.box_min, second.box_min) ||
                                  node.box_max != glm::max(first.box_max, second.box_max))) {
      return node_name(index) + " has a box larger than the union of its children's";
    }
    return {};
  }

  Fault find_in_triangles() const {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (!is_finite(triangles_[i])) continue;
      if (leaves_[i] == 0) return triangle_name(i) + " is in no leaf";
      if (corners_[i] != ALL_CORNERS) {
        return triangle_name(i) + " has a corner outside of the boxes of its leaves";
      }
    }
    return {};
  }

  std::span<const Node> nodes_;
  std::span<const Triangle> triangles_;
  TreePromises promises_;
  std::vector<std::uint8_t> reached_;
  std::vector<std::uint32_t> leaves_;  // of each triangle
  std::vector<std::uint8_t> corners_;
  std::size_t leaf_count_ = 0;
};

}  // namespace

std::optional<std::string> find_fault(std::span<const Node> nodes, std::span<const Triangle> triangles,
                                      const TreePromises& promises) {
  return TreeValidation(nodes, triangles, promises).find();
}

}  // namespace coppice
