#include "builders/reference_tree.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "builders/leaves.h"

namespace coppice {
namespace {

namespace tbb = oneapi::tbb;

// Subtrees of fewer references stay with one thread.
constexpr std::uint32_t TASK_REFERENCES = 4096;
// A link with this bit leads to a leaf.
constexpr std::uint32_t LEAF_BIT = 1u << 31;

// A node to be split. The places [first, first + capacity) of all arrays belong to its subtree alone.
struct Subtree {
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

template <class Work>
void with_threads(std::uint32_t threads, const Work& work) {
  constexpr std::uint32_t most = 1024;
  const int usual = tbb::info::default_concurrency();
  const int count = threads == 0 ? usual : static_cast<int>(std::min(threads, most));
  // TBB starts no more threads than there are processors unless it is told to.
  std::optional<tbb::global_control> control;
  if (count > usual) {
    control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  }
  tbb::task_arena(count).execute(work);
}

class ReferenceTree {
 public:
  ReferenceTree(std::uint32_t capacity, const ReferenceSplitter& splitter)
      : splitter_(splitter),
        links_(std::make_unique_for_overwrite<std::uint32_t[]>(2 * std::size_t{capacity})) {
    for (auto& references : references_) references = std::make_unique_for_overwrite<Reference[]>(capacity);
  }

  void build(std::span<const Reference> leaves, std::uint32_t capacity) {
    tasks_.run_and_wait([&] { build_subtree({leaves, 0, capacity, 0, 0, false}); });
  }

  bool cap_reached() const { return cap_reached_; }

  // Depth-first, siblings together. A node stands before its children.
  std::vector<Node> take_nodes() {
    references_[1].reset();
    std::vector<Node> nodes(2 * std::size_t{leaf_count_} - 1);
    std::vector<std::array<std::uint32_t, 2>> stack = {{links_[0], 0}};  // a link's value and its node
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
      if (nodes[i].height > 0) set_from_children(nodes, nodes[i]);
    }
    return nodes;
  }

 private:
  static void set_from_children(std::span<const Node> nodes, Node& node) {
    const Node& first = nodes[node.child];
    const Node& second = nodes[node.child + 1];
    const Aabb box = box_union({first.box_min, first.box_max}, {second.box_min, second.box_max});
    node = {box.box_min, node.child, box.box_max, 1 + std::max(first.height, second.height)};
  }

  void build_subtree(const Subtree& root) {
    std::uint32_t leaf_count = 0;
    std::vector<Subtree> stack = {root};
    while (!stack.empty()) {
      const Subtree subtree = stack.back();
      stack.pop_back();
      if (subtree.references.size() == 1) {
        references_[0][subtree.first] = subtree.references[0];
        links_[subtree.link] = LEAF_BIT | subtree.first;
        ++leaf_count;
        continue;
      }
      for (const Subtree& child : split(subtree)) {
        if (child.references.size() >= TASK_REFERENCES) {
          tasks_.run([this, child] { build_subtree(child); });
        } else {
          stack.push_back(child);
        }
      }
    }
    leaf_count_ += leaf_count;
  }

  // The right child first: the left one is taken off the stack before it.
  std::array<Subtree, 2> split(const Subtree& subtree) {
    // Children's references go to the array that their parent's are not in.
    Reference* place = (subtree.depth % 2 == 0 ? references_[0] : references_[1]).get() + subtree.first;
    SplitSides sides(place, place + subtree.capacity);
    const auto count = static_cast<std::uint32_t>(subtree.references.size());
    const bool too_deep =
        subtree.depth + static_cast<std::uint32_t>(std::bit_width(count)) >= REFERENCE_TREE_MAX_HEIGHT;
    if (!subtree.halve && !too_deep) {
      splitter_.split({subtree.references, subtree.capacity - count}, sides);
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
  std::array<Subtree, 2> children_of(const Subtree& subtree, const SplitSides& sides) {
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
  std::array<std::unique_ptr<Reference[]>, 2> references_;
  std::unique_ptr<std::uint32_t[]> links_;  // 2 * middle and 2 * middle + 1; the root's at 0
  std::atomic<std::uint32_t> leaf_count_ = 0;
  std::atomic<bool> cap_reached_ = false;
  tbb::task_group tasks_;
};

}  // namespace

Bvh build_reference_tree(std::span<const Triangle> triangles, const ReferenceCap& cap,
                         const ReferenceSplitter& splitter, std::uint32_t threads) {
  Bvh bvh;
  const std::vector<Node> leaves = make_leaves(triangles);
  const std::uint32_t capacity = capacity_of(cap, leaves.size());
  bvh.active_count = static_cast<std::uint32_t>(leaves.size());
  if (leaves.empty()) return bvh;
  ReferenceTree tree(capacity, splitter);
  with_threads(threads, [&] { tree.build(leaves, capacity); });
  bvh.nodes = tree.take_nodes();
  bvh.references = (bvh.nodes.size() + 1) / 2;
  bvh.reference_cap_reached = tree.cap_reached();
  return bvh;
}

}  // namespace coppice
