#include "builders/reference_tree_rotations.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "builders/lane_box.h"
#include "builders/subtree.h"

namespace coppice {
namespace {

// Less is rounding.
constexpr float LEAST_GAIN = 1e-6f;

// Two nodes that change places.
struct Rotation {
  float gain;
  std::uint32_t first = 0, second = 0;
};

class Rotations {
 public:
  Rotations(std::span<Node> nodes, float scale, std::uint32_t height_limit)
      : nodes_(nodes), scale_(scale), height_limit_(height_limit) {}

  void rotate_all() {
    std::vector<std::uint8_t> depths(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].height == 0) continue;
      depths[nodes_[i].child] = depths[nodes_[i].child + 1] = static_cast<std::uint8_t>(depths[i] + 1);
    }
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      if (nodes_[i].height > 0) rotate(nodes_[i], height_limit_ - depths[i]);
    }
  }

 private:
  bool is_leaf(std::uint32_t i) const { return nodes_[i].height == 0; }
  float area(std::uint32_t i) const { return half_area(lane_box(nodes_[i]), scale_); }
  float area(std::uint32_t i, std::uint32_t k) const {
    return half_area(lane_union(lane_box(nodes_[i]), lane_box(nodes_[k])), scale_);
  }

  // The subtrees below the node are done, and keep within the limit.
  void rotate(Node& node, std::uint32_t height_limit) {
    fit_to_children(node, nodes_);
    const std::uint32_t left = node.child, right = left + 1;
    Rotation best{LEAST_GAIN * half_area(lane_box(node), scale_)};
    if (!is_leaf(left)) try_child(right, left, best);
    if (!is_leaf(right)) try_child(left, right, best);
    if (!is_leaf(left) && !is_leaf(right)) try_cousins(left, right, best);
    if (best.first == best.second) return;
    change_places(node, best);
    // Done twice it is undone.
    if (node.height > height_limit) change_places(node, best);
  }

  void try_child(std::uint32_t child, std::uint32_t sibling, Rotation& best) const {
    const std::uint32_t grandchild = nodes_[sibling].child;
    const float area_now = area(sibling);
    for (std::uint32_t k = 0; k < 2; ++k) {
      const float gain = area_now - area(child, grandchild + 1 - k);
      if (gain > best.gain) best = {gain, child, grandchild + k};
    }
  }

  void try_cousins(std::uint32_t left, std::uint32_t right, Rotation& best) const {
    const std::uint32_t nephew = nodes_[left].child, cousin = nodes_[right].child;
    const float area_now = area(left) + area(right);
    for (std::uint32_t k = 0; k < 2; ++k) {
      const float gain = area_now - area(cousin + k, nephew + 1) - area(nephew, cousin + 1 - k);
      if (gain > best.gain) best = {gain, nephew, cousin + k};
    }
  }

  void change_places(Node& node, const Rotation& rotation) {
    std::swap(nodes_[rotation.first], nodes_[rotation.second]);
    for (Node& child : nodes_.subspan(node.child, 2)) {
      if (child.height > 0) fit_to_children(child, nodes_);
    }
    fit_to_children(node, nodes_);
  }

  std::span<Node> nodes_;
  float scale_;
  std::uint32_t height_limit_;
};

void copy_depth_first(std::span<const Node> from, std::span<Node> to) {
  std::vector<std::array<std::uint32_t, 2>> stack = {{0, 0}};  // where a node is and where it goes
  std::uint32_t next = 1;
  while (!stack.empty()) {
    const auto [source, place] = stack.back();
    stack.pop_back();
    to[place] = from[source];
    if (from[source].height == 0) continue;
    const std::uint32_t child = std::exchange(to[place].child, next);
    stack.push_back({child + 1, next + 1});
    stack.push_back({child, next});
    next += 2;
  }
}

}  // namespace

void rotate_tree(std::span<Node> nodes, std::span<Node> rotated, float scale, std::uint32_t height_limit) {
  Rotations(nodes, scale, height_limit).rotate_all();
  copy_depth_first(nodes, rotated);
}

}  // namespace coppice
