#include "builders/reference_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "builders/lane_box.h"
#include "builders/leaves.h"
#include "builders/reference_tree_rotations.h"
#include "builders/subtree.h"
#include "builders/threads.h"

namespace coppice {
namespace {

// Nodes of more references are split by all threads together, the subtrees below are each built by one.
constexpr std::size_t SHARED_REFERENCES = 1 << 14;
// A link with this bit leads to a leaf.
constexpr std::uint32_t LEAF_BIT = 1u << 31;

// A node to be split. The places [first, first + capacity) of all arrays belong to its subtree alone.
struct ReferenceSubtree {
  std::span<const Reference> references;
  std::uint32_t first;
  std::uint32_t capacity;
  std::uint32_t link;  // which link leads to it
  std::uint32_t depth;
  bool halve;
};

std::uint32_t capacity_of(const ReferenceCap& cap, std::size_t active_count) {
  if (!(cap.per_triangle >= 1.0) || !std::isfinite(cap.per_triangle)) {
    throw std::invalid_argument("A cap of fewer than one reference a triangle");
  }
  if (active_count >= LEAF_BIT) throw std::length_error("more than 2^31 - 1 triangles");
  const double wanted = cap.per_triangle * static_cast<double>(active_count) + cap.constant;
  return static_cast<std::uint32_t>(std::min(wanted, double{LEAF_BIT - 1}));
}

double total_extent(std::span<const Reference> references) {
  double sum = 0.0;
  for (const Reference& reference : references) {
    for (int axis = 0; axis < 3; ++axis) sum += double{reference.box_max[axis]} - reference.box_min[axis];
  }
  return sum;
}

// A node that all threads split together, or the root of a subtree that one thread builds.
struct Upper {
  ReferenceSubtree subtree;
  std::uint32_t left = 0;        // the left child's index; the right one's follows; 0 where one thread builds
  std::uint32_t leaf_count = 0;  // of the subtree
  // The node's place, and where those of the nodes below it begin.
  std::uint32_t node = 0, places = 1;
};

class ReferenceTree {
 public:
  ReferenceTree(std::uint32_t capacity, const ReferenceSplitter& splitter, const Threads& threads)
      : splitter_(splitter),
        threads_(threads),
        links_(std::make_unique_for_overwrite<std::uint32_t[]>(2 * std::size_t{capacity})) {
    for (auto& references : references_) references = std::make_unique_for_overwrite<Reference[]>(capacity);
  }

  void split_all(std::span<const Reference> leaves, std::uint32_t capacity) {
    uppers_.push_back({{leaves, 0, capacity, 0, 0, false}});
    for (std::uint32_t i = 0; i < uppers_.size(); ++i) {
      if (uppers_[i].subtree.references.size() <= SHARED_REFERENCES) {
        parts_.push_back(i);
        continue;
      }
      const auto children = split(uppers_[i].subtree, &threads_);
      uppers_[i].left = static_cast<std::uint32_t>(uppers_.size());
      uppers_.push_back({children[1]});
      uppers_.push_back({children[0]});
    }
    threads_.for_each(parts_.size(), [&](std::size_t k) {
      uppers_[parts_[k]].leaf_count = split_alone(uppers_[parts_[k]].subtree);
    });
    references_[1].reset();
  }

  // Depth-first, siblings together. A node stands before its children.
  std::vector<Node> take_nodes(float scale, std::uint32_t rotation_passes) {
    place_uppers();
    std::vector<Node> nodes(2 * std::size_t{uppers_[0].leaf_count} - 1);
    threads_.for_each(parts_.size(), [&](std::size_t k) {
      const Upper& part = uppers_[parts_[k]];
      std::vector<Node> tree = linked_nodes(part);
      std::vector<Node> rotated(rotation_passes > 0 ? tree.size() : 0);
      for (std::uint32_t pass = 0; pass < rotation_passes; ++pass) {
        rotate_tree(tree, rotated, scale, REFERENCE_TREE_MAX_HEIGHT - part.subtree.depth);
        tree.swap(rotated);
      }
      for (Node& node : tree) {
        if (node.height > 0) node.child += part.places - 1;
      }
      nodes[part.node] = tree[0];
      std::copy(tree.begin() + 1, tree.end(), nodes.begin() + part.places);
    });
    for (std::size_t i = uppers_.size(); i-- > 0;) {
      if (uppers_[i].left == 0) continue;
      Node& node = nodes[uppers_[i].node];
      node.child = uppers_[i].places;
      fit_to_children(node, nodes);
    }
    return nodes;
  }

  bool cap_reached() const { return cap_reached_; }

 private:
  // Splits down to leaves and returns how many these are.
  std::uint32_t split_alone(const ReferenceSubtree& root) {
    std::uint32_t leaf_count = 0;
    std::vector<ReferenceSubtree> stack = {root};
    while (!stack.empty()) {
      const ReferenceSubtree subtree = stack.back();
      stack.pop_back();
      if (subtree.references.size() > 1) {
        for (const ReferenceSubtree& child : split(subtree, nullptr)) stack.push_back(child);
        continue;
      }
      references_[0][subtree.first] = subtree.references[0];
      links_[subtree.link] = LEAF_BIT | subtree.first;
      ++leaf_count;
    }
    return leaf_count;
  }

  void place_uppers() {
    for (std::size_t i = uppers_.size(); i-- > 0;) {
      Upper& upper = uppers_[i];
      if (upper.left != 0) {
        upper.leaf_count = uppers_[upper.left].leaf_count + uppers_[upper.left + 1].leaf_count;
      }
    }
    for (const Upper& upper : uppers_) {
      if (upper.left == 0) continue;
      Upper &left = uppers_[upper.left], &right = uppers_[upper.left + 1];
      left.node = upper.places;
      left.places = upper.places + 2;
      right.node = upper.places + 1;
      right.places = upper.places + 2 * left.leaf_count;
    }
  }

  // The subtree as a tree of its own.
  std::vector<Node> linked_nodes(const Upper& part) const {
    std::vector<Node> nodes(2 * std::size_t{part.leaf_count} - 1);
    std::vector<std::array<std::uint32_t, 2>> stack = {
        {links_[part.subtree.link], 0}};  // to a node, its place
    std::uint32_t next = 1;
    while (!stack.empty()) {
      const auto [link, node] = stack.back();
      stack.pop_back();
      if (link & LEAF_BIT) {
        nodes[node] = references_[0][link & ~LEAF_BIT];
        continue;
      }
      nodes[node] = {vec3(0), next, vec3(0), 1};
      stack.push_back({links_[2 * std::size_t{link} + 1], next + 1});
      stack.push_back({links_[2 * std::size_t{link}], next});
      next += 2;
    }
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (nodes[i].height > 0) fit_to_children(nodes[i], nodes);
    }
    return nodes;
  }

  // The right child first: the left one is taken off the stack before it.
  std::array<ReferenceSubtree, 2> split(const ReferenceSubtree& subtree, const Threads* together) {
    // Children's references go to the array that their parent's are not in.
    Reference* place = (subtree.depth % 2 == 0 ? references_[0] : references_[1]).get() + subtree.first;
    SplitSides sides(place, place + subtree.capacity);
    const auto count = static_cast<std::uint32_t>(subtree.references.size());
    const bool too_deep =
        subtree.depth + static_cast<std::uint32_t>(std::bit_width(count)) >= REFERENCE_TREE_MAX_HEIGHT;
    if (!subtree.halve && !too_deep) {
      splitter_.split({subtree.references, subtree.capacity - count, together}, sides);
      if (sides.cap_reached) cap_reached_ = true;
    }
    if (sides.left().empty() || sides.right().empty()) {
      sides.clear();
      for (std::uint32_t i = 0; i < count; ++i) {
        i < count / 2 ? sides.push_left(subtree.references[i]) : sides.push_right(subtree.references[i]);
      }
    }
    return children_of(subtree, sides);
  }

  // The children meet at a place that is between those of no other two siblings: it names their links.
  std::array<ReferenceSubtree, 2> children_of(const ReferenceSubtree& subtree, const SplitSides& sides) {
    const auto left_count = static_cast<std::uint32_t>(sides.left().size());
    const auto right_count = static_cast<std::uint32_t>(sides.right().size());
    const std::uint32_t left_capacity =
        left_count + left_spare(sides, subtree.capacity - left_count - right_count);
    const std::uint32_t middle = subtree.first + left_capacity;
    links_[subtree.link] = middle;
    const bool halve = subtree.halve || sides.halve_below;
    const std::uint32_t depth = subtree.depth + 1;
    return {{{sides.right(), middle, subtree.capacity - left_capacity, 2 * middle + 1, depth, halve},
             {sides.left(), subtree.first, left_capacity, 2 * middle, depth, halve}}};
  }

  // What the left child may have of the spare references: in proportion to the total length of its
  // references, since the longer a triangle, the more parts of it are worth having.
  static std::uint32_t left_spare(const SplitSides& sides, std::uint32_t spare) {
    if (spare == 0) return 0;
    const double left = total_extent(sides.left()), both = left + total_extent(sides.right());
    return both > 0.0 ? std::min(static_cast<std::uint32_t>(spare * (left / both)), spare) : spare / 2;
  }

  const ReferenceSplitter& splitter_;
  const Threads& threads_;
  std::array<std::unique_ptr<Reference[]>, 2> references_;
  std::unique_ptr<std::uint32_t[]> links_;  // 2 * middle and 2 * middle + 1; the root's at 0
  std::vector<Upper> uppers_;               // breadth-first
  std::vector<std::uint32_t> parts_;        // those that one thread builds
  std::atomic<bool> cap_reached_ = false;
};

}  // namespace

Bvh build_reference_tree(std::span<const Triangle> triangles, const ReferenceCap& cap,
                         const ReferenceSplitter& splitter, std::uint32_t thread_count,
                         std::uint32_t rotation_passes) {
  Bvh bvh;
  const Threads threads(thread_count);
  std::vector<Node> leaves = make_leaves(triangles, threads);
  const std::uint32_t capacity = capacity_of(cap, leaves.size());
  bvh.active_count = static_cast<std::uint32_t>(leaves.size());
  if (leaves.empty()) return bvh;
  const float scale = centre_scale(bounds_of(leaves, threads));
  ReferenceTree tree(capacity, splitter, threads);
  tree.split_all(leaves, capacity);
  leaves = {};
  bvh.nodes = tree.take_nodes(scale, rotation_passes);
  bvh.references = (bvh.nodes.size() + 1) / 2;
  bvh.reference_cap_reached = tree.cap_reached();
  return bvh;
}

}  // namespace coppice
