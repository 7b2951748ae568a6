#include "builders/lbvh.h"

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "builders/morton_leaves.h"
#include "builders/subtree.h"
#include "builders/threads.h"

namespace coppice {
namespace {

// Leaves that a thread takes at a time.
constexpr std::size_t LBVH_CHUNK = 1 << 12;

// Split s separates the leaves at places s and s + 1. It names the internal node that it splits: the children
// stand at 1 + 2s and 2 + 2s, so that neighbours in space are neighbours in memory.
class RadixTree {
 public:
  RadixTree(const MortonLeaves& leaves, std::vector<Node>& nodes, const Threads& threads)
      : leaves_(leaves), nodes_(nodes), threads_(threads) {}

  void build() {
    const std::size_t splits = leaves_.count() - 1;
    differences_.resize(splits);
    far_ends_ = std::make_unique_for_overwrite<std::atomic<std::uint32_t>[]>(splits);
    threads_.for_each_chunk(splits, LBVH_CHUNK, [&](Chunk chunk, std::size_t) {
      for (std::size_t s = chunk.begin; s < chunk.end; ++s) {
        differences_[s] = difference_at(static_cast<std::uint32_t>(s));
        far_ends_[s].store(NONE, std::memory_order_relaxed);
      }
    });
    threads_.for_each_chunk(leaves_.count(), LBVH_CHUNK, [&](Chunk chunk, std::size_t) {
      for (std::size_t i = chunk.begin; i < chunk.end; ++i) climb_from(static_cast<std::uint32_t>(i));
    });
  }

 private:
  static constexpr std::uint32_t NONE = ~0u;

  // What differs between the leaves on both sides, the more the later in the tree they meet. Codes that are
  // equal differ less than all others: by their places.
  struct Difference {
    std::uint64_t of_codes;
    std::uint32_t of_places;
    auto operator<=>(const Difference&) const = default;
  };

  Difference difference_at(std::uint32_t split) const {
    return {leaves_.code(split) ^ leaves_.code(split + 1), split ^ (split + 1)};
  }

  // The node of the leaves from `first` to `last` lies below the split, at either end, that separates less.
  bool is_first_child(std::uint32_t first, std::uint32_t last) const {
    if (first == 0) return true;
    if (last == differences_.size()) return false;
    return differences_[last] < differences_[first - 1];
  }

  // Goes up while the other child is there already; whoever comes second makes the parent.
  void climb_from(std::uint32_t leaf) {
    std::uint32_t first = leaf, last = leaf;
    Node node = leaves_.leaf(leaf);
    while (first != 0 || last != differences_.size()) {
      const bool is_first = is_first_child(first, last);
      const std::uint32_t split = is_first ? last : first - 1;
      const std::uint32_t child = 1 + 2 * split;
      nodes_[is_first ? child : child + 1] = node;
      // Releases the node just written, and acquires the sibling's: partner is the same line of the other.
      const std::uint32_t far_end =
          far_ends_[split].exchange(is_first ? first : last, std::memory_order_acq_rel);
      if (far_end == NONE) return;
      (is_first ? last : first) = far_end;
      node.child = child;
      fit_to_children(node, nodes_);
    }
    nodes_[0] = node;
  }

  const MortonLeaves& leaves_;
  std::vector<Node>& nodes_;
  const Threads& threads_;
  std::vector<Difference> differences_;  // of each split
  // For each split the other end of the child that came first.
  std::unique_ptr<std::atomic<std::uint32_t>[]> far_ends_;
};

}  // namespace

Bvh build_lbvh(std::span<const Triangle> triangles, const LbvhConfig& config) {
  if (config.morton_bits != 30 && config.morton_bits != 60) {
    throw std::invalid_argument("Morton codes of " + std::to_string(config.morton_bits) +
                                " bits: there are 30 and 60");
  }
  const Threads threads(config.threads);
  const MortonLeaves leaves = make_morton_leaves(triangles, config.morton_bits, threads);
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(leaves.count());
  if (leaves.count() == 0) return bvh;
  bvh.nodes.resize(2 * leaves.count() - 1);
  RadixTree(leaves, bvh.nodes, threads).build();
  return bvh;
}

}  // namespace coppice
