#include "analysis/wide_tree.h"

#include <algorithm>
#include <bit>
#include <glm/common.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <vector>

namespace coppice {
namespace {

using Fault = std::optional<std::string>;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr Aabb nothing{vec3(infinity), vec3(-infinity)};
constexpr std::uint8_t inverted[] = {255, 255, 255, 0, 0, 0};

std::uint8_t plane_byte(const WideNode& node, uint byte) { return node.planes[byte / 4] >> byte % 4 * 8; }

bool is_inverted(const WideNode& node, uint child) {
  for (uint byte = 0; byte < 6; ++byte) {
    if (plane_byte(node, 6 * child + byte) != inverted[byte]) return false;
  }
  return true;
}

bool is_wide(uint child) { return (child & WIDE_LEAF) == 0; }

uint child_count(const WideNode& node) {
  return static_cast<uint>(std::ranges::find(node.child, WIDE_EMPTY) - node.child);
}

Aabb united(const Aabb& a, const Aabb& b) {
  return {glm::min(a.box_min, b.box_min), glm::max(a.box_max, b.box_max)};
}

bool contains(const Aabb& outer, const Aabb& inner) {
  return glm::all(glm::lessThanEqual(outer.box_min, inner.box_min)) &&
         glm::all(glm::lessThanEqual(inner.box_max, outer.box_max));
}

bool is_nothing(const Aabb& box) { return glm::any(glm::greaterThan(box.box_min, box.box_max)); }

double half_area(const Aabb& box) {
  if (is_nothing(box)) return 0;
  const glm::dvec3 extent = glm::dvec3(box.box_max) - glm::dvec3(box.box_min);
  return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

std::string wide_name(std::size_t node) { return "wide node " + std::to_string(node); }
std::string wide_name(std::size_t node, uint child) {
  return "child " + std::to_string(child) + " of " + wide_name(node);
}

class WideValidation {
 public:
  WideValidation(std::span<const WideNode> wide_nodes, std::span<const Node> nodes, bool refitted)
      : wide_(wide_nodes), boxes_(wide_nodes.size(), nothing), refitted_(refitted) {
    for (const Node& node : nodes) {
      if (node.height != 0) continue;
      leaves_.resize(std::max<std::size_t>(leaves_.size(), node.child + std::size_t{1}));
      leaves_[node.child] = {{node.box_min, node.box_max}, 1};
    }
    binary_height_ = nodes.empty() ? 0 : nodes[0].height;
    leaf_count_ = (nodes.size() + 1) / 2;
  }

  Fault find() {
    if (wide_.empty() != (leaf_count_ == 0)) return std::to_string(wide_.size()) + " wide nodes";
    if (Fault fault = find_in_order()) return fault;
    for (std::size_t triangle = 0; triangle < leaves_.size(); ++triangle) {
      if (leaves_[triangle].uses == 1) return "triangle " + std::to_string(triangle) + " is in no leaf";
    }
    // Children stand behind their parents: from the last node on, what lies below one is known.
    for (std::size_t node = wide_.size(); node-- > 0;) {
      if (Fault fault = find_in_boxes(node)) return fault;
    }
    return {};
  }

 private:
  struct Leaf {
    Aabb box;
    std::uint32_t uses = 0;  // 0: the triangle is in no leaf of the binary tree; else leaves, of both trees
  };
  struct Open {
    uint node;
    std::uint32_t level;
  };

  Fault find_in_order() {
    std::vector<Open> stack;
    if (!wide_.empty()) stack.push_back({0, 1});
    for (std::size_t expected = 0; expected < wide_.size(); ++expected) {
      if (stack.empty()) return wide_name(expected) + " is not reached from the root";
      const Open open = stack.back();
      stack.pop_back();
      if (open.node != expected)
        return wide_name(open.node) + " is the next in depth-first order, not " + std::to_string(expected);
      if (open.level > std::max(binary_height_, 1u))
        return wide_name(expected) + " lies below all binary nodes";
      if (Fault fault = find_in_children(expected)) return fault;
      for (uint c = child_count(wide_[expected]); c-- > 0;) {
        if (is_wide(wide_[expected].child[c])) stack.push_back({wide_[expected].child[c], open.level + 1});
      }
    }
    if (!stack.empty()) return wide_name(stack.back().node) + " is not there";
    return {};
  }

  Fault find_in_children(std::size_t index) {
    const WideNode& node = wide_[index];
    const uint count = child_count(node);
    bool wide_child = false;
    for (uint c = 0; c < WIDE_CHILDREN; ++c) {
      if (c >= count) {
        if (node.child[c] != WIDE_EMPTY) return wide_name(index, c) + " stands behind an empty one";
        if (!is_inverted(node, c)) return wide_name(index, c) + " is empty and has a box";
        continue;
      }
      wide_child |= is_wide(node.child[c]);
      if (is_wide(node.child[c])) continue;
      const uint triangle = node.child[c] - WIDE_LEAF;
      if (triangle >= leaves_.size() || leaves_[triangle].uses == 0)
        return wide_name(index, c) + " is triangle " + std::to_string(triangle) +
               ", which the binary tree has not";
      if (leaves_[triangle].uses++ > 1)
        return "triangle " + std::to_string(triangle) + " is in more than one leaf";
    }
    if (count < std::min<std::size_t>(2, leaf_count_)) return wide_name(index) + " has too few children";
    if (wide_child && count < WIDE_LEAST_CHILDREN)
      return wide_name(index) + " has a child that had room to be opened";
    return {};
  }

  Fault find_in_boxes(std::size_t index) {
    for (uint c = 0; c < child_count(wide_[index]); ++c) {
      const uint child = wide_[index].child[c];
      const Aabb below = is_wide(child) ? boxes_[child] : leaves_[child - WIDE_LEAF].box;
      const Aabb decoded = decoded_box(wide_[index], c);
      if (is_nothing(below) ? !is_nothing(decoded) : !contains(decoded, below))
        return wide_name(index, c) + " has a box that does not contain what is below it";
      boxes_[index] = united(boxes_[index], below);
    }
    return find_unopened(index);
  }

  // The areas that decided were normalised ones, so what is small within a rounding may pass.
  Fault find_unopened(std::size_t index) {
    if (refitted_) return {};
    const WideNode& node = wide_[index];
    const double small = half_area(boxes_[index]) / WIDE_SMALL_PARTS * (1 + 0x1p-20);
    if (child_count(node) == WIDE_CHILDREN) return {};
    for (uint c = 0; c < child_count(node); ++c) {
      if (is_wide(node.child[c]) && !(half_area(boxes_[node.child[c]]) <= small))
        return wide_name(index) + " has a child that had room to be opened";
    }
    return {};
  }

  std::span<const WideNode> wide_;
  std::vector<Aabb> boxes_;   // of the binary tree's leaves below each wide node
  std::vector<Leaf> leaves_;  // by triangle
  std::uint32_t binary_height_;
  std::size_t leaf_count_;
  bool refitted_;
};

}  // namespace

Aabb decoded_box(const WideNode& node, uint child) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = std::bit_cast<float>((node.exponents >> 8 * axis & 255) << 23);
    const auto plane = [&](uint byte) {
      return node.origin[axis] + static_cast<float>(plane_byte(node, 6 * child + byte)) * step;
    };
    box.box_min[axis] = plane(axis);
    box.box_max[axis] = plane(3 + axis);
  }
  return box;
}

std::optional<std::string> find_wide_fault(std::span<const WideNode> wide_nodes, std::span<const Node> nodes,
                                           bool refitted) {
  return WideValidation(wide_nodes, nodes, refitted).find();
}

double WideQuality::children_per_node() const {
  return nodes == 0 ? 0 : static_cast<double>(children) / static_cast<double>(nodes);
}

WideQuality measure_wide_quality(std::span<const WideNode> wide_nodes) {
  WideQuality quality;
  if (wide_nodes.empty()) return quality;
  quality.nodes = wide_nodes.size();
  Aabb root = nothing;
  for (uint c = 0; c < child_count(wide_nodes[0]); ++c) root = united(root, decoded_box(wide_nodes[0], c));
  const double root_area = half_area(root);
  quality.sah = 1;
  std::vector<std::uint32_t> levels(wide_nodes.size(), 1);
  for (std::size_t index = 0; index < wide_nodes.size(); ++index) {
    const WideNode& node = wide_nodes[index];
    quality.levels = std::max(quality.levels, levels[index]);
    for (uint c = 0; c < child_count(node); ++c) {
      ++quality.children;
      quality.sah += root_area > 0 ? half_area(decoded_box(node, c)) / root_area : 1.0;
      if (is_wide(node.child[c])) levels[node.child[c]] = levels[index] + 1;
    }
  }
  return quality;
}

}  // namespace coppice
