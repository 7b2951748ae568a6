#include "builders/sah.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "builders/leaves.h"
#include "builders/sah_bins.h"
#include "builders/subtree.h"
#include "builders/threads.h"

namespace coppice {
namespace {

// Nodes of more triangles are split by all threads together, those below are each built by one thread.
constexpr std::uint32_t SHARED_LEAVES = 1 << 14;
constexpr std::size_t SAH_CHUNK = 1 << 12;

// Small nodes are the many: there fewer bins serve as well, as in Embree.
std::uint32_t bin_count_for(std::uint32_t count) { return std::min(4 + count / 16, Bins::LIMIT); }

LaneBox centre_bounds(std::span<const Node> leaves, float scale) {
  LaneBox bounds = EMPTY_LANE_BOX;
  for (const Node& leaf : leaves) {
    const Floats centre = scaled_centre(lane_box(leaf), scale);
    bounds = lane_union(bounds, {centre, centre});
  }
  return bounds;
}

std::uint32_t list_middle(const Subtree& subtree) { return subtree.begin + subtree.count() / 2; }

// Splits where one thread has the node to itself.
std::uint32_t split(const Subtree& subtree, std::span<Node> all_leaves, float scale) {
  if (subtree.count() == 2 || must_halve(subtree)) return list_middle(subtree);
  const std::span<Node> leaves = all_leaves.subspan(subtree.begin, subtree.count());
  const BinGrid grid(centre_bounds(leaves, scale), bin_count_for(subtree.count()), scale);
  if (grid.is_flat()) return list_middle(subtree);
  Bins bins(grid.bin_count());
  bins.add(leaves, grid);
  const auto best = bins.best_split(scale);
  if (!best) return list_middle(subtree);
  // Every leaf changes places with the first one of the second part, and stays there if it is of the first:
  // no branch that the processor would have to guess.
  std::size_t middle = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Node leaf = leaves[i];
    leaves[i] = leaves[middle];
    leaves[middle] = leaf;
    middle += grid.bins_of(lane_box(leaf))[best->axis] < best->first_bin;
  }
  return subtree.begin + static_cast<std::uint32_t>(middle);
}

// The nodes that all threads split together, and what is left below them.
class SharedSplits {
 public:
  SharedSplits(std::vector<Node>& leaves, std::vector<Node>& nodes, float scale, const Threads& threads)
      : leaves_(leaves),
        spare_(std::make_unique_for_overwrite<Node[]>(leaves.size())),
        nodes_(nodes),
        scale_(scale),
        threads_(threads) {}

  void build() {
    std::vector<Subtree> stack = {whole_tree(static_cast<std::uint32_t>(leaves_.size()))};
    std::vector<std::uint32_t> split_nodes;
    std::vector<Subtree> parts;
    while (!stack.empty()) {
      const Subtree top = stack.back();
      stack.pop_back();
      if (top.count() <= SHARED_LEAVES) {
        parts.push_back(top);
        continue;
      }
      const std::uint32_t middle = split_together(top);
      nodes_[top.node].child = top.places;
      split_nodes.push_back(top.node);
      stack.push_back(top.second_part(middle));
      stack.push_back(top.first_part(middle));
    }
    threads_.for_each(parts.size(), [&](std::size_t k) {
      split_subtree(
          parts[k], [&](std::uint32_t i) { return leaves_[i]; }, nodes_,
          [&](const Subtree& subtree) { return split(subtree, leaves_, scale_); });
    });
    for (std::size_t k = split_nodes.size(); k-- > 0;) fit_to_children(nodes_[split_nodes[k]], nodes_);
  }

 private:
  std::uint32_t split_together(const Subtree& subtree) {
    if (must_halve(subtree)) return list_middle(subtree);
    const std::span<Node> leaves = std::span(leaves_).subspan(subtree.begin, subtree.count());
    const std::size_t chunks = chunk_count(leaves.size(), SAH_CHUNK);
    std::vector<LaneBox> bounds(chunks);
    threads_.for_each_chunk(leaves.size(), SAH_CHUNK, [&](Chunk chunk, std::size_t k) {
      bounds[k] = centre_bounds(leaves.subspan(chunk.begin, chunk.count()), scale_);
    });
    LaneBox all_bounds = EMPTY_LANE_BOX;
    for (const LaneBox& box : bounds) all_bounds = lane_union(all_bounds, box);
    const BinGrid grid(all_bounds, bin_count_for(subtree.count()), scale_);
    if (grid.is_flat()) return list_middle(subtree);

    std::vector<Bins> bins(chunks, Bins(grid.bin_count()));
    threads_.for_each_chunk(leaves.size(), SAH_CHUNK, [&](Chunk chunk, std::size_t k) {
      bins[k].add(leaves.subspan(chunk.begin, chunk.count()), grid);
    });
    for (std::size_t k = 1; k < chunks; ++k) bins[0].add(bins[k]);
    const auto best = bins[0].best_split(scale_);
    return best ? partition_together(subtree, grid, *best) : list_middle(subtree);
  }

  // Stable, so that the order does not depend on which thread comes first.
  std::uint32_t partition_together(const Subtree& subtree, const BinGrid& grid, const BinSplit& best) {
    const std::span<Node> leaves = std::span(leaves_).subspan(subtree.begin, subtree.count());
    const std::span<Node> spare(spare_.get() + subtree.begin, subtree.count());
    // Each chunk gathers its first part from its front and its second part from its back.
    std::vector<std::size_t> first_counts(chunk_count(leaves.size(), SAH_CHUNK));
    threads_.for_each_chunk(leaves.size(), SAH_CHUNK, [&](Chunk chunk, std::size_t k) {
      std::size_t front = chunk.begin, back = chunk.end;
      for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
        const bool is_first = grid.bins_of(lane_box(leaves[i]))[best.axis] < best.first_bin;
        spare[is_first ? front : back - 1] = leaves[i];
        front += is_first;
        back -= !is_first;
      }
      first_counts[k] = front - chunk.begin;
    });
    std::vector<std::size_t> firsts_before(first_counts.size());
    std::size_t middle = 0;
    for (std::size_t k = 0; k < first_counts.size(); ++k) {
      firsts_before[k] = middle;
      middle += first_counts[k];
    }
    threads_.for_each_chunk(leaves.size(), SAH_CHUNK, [&](Chunk chunk, std::size_t k) {
      const auto from = spare.begin() + static_cast<std::ptrdiff_t>(chunk.begin);
      const auto split = from + static_cast<std::ptrdiff_t>(first_counts[k]);
      const std::size_t seconds_before = chunk.begin - firsts_before[k];
      std::copy(from, split, leaves.begin() + static_cast<std::ptrdiff_t>(firsts_before[k]));
      std::copy(split, from + static_cast<std::ptrdiff_t>(chunk.count()),
                leaves.begin() + static_cast<std::ptrdiff_t>(middle + seconds_before));
    });
    return subtree.begin + static_cast<std::uint32_t>(middle);
  }

  std::vector<Node>& leaves_;
  std::unique_ptr<Node[]> spare_;
  std::vector<Node>& nodes_;
  float scale_;
  const Threads& threads_;
};

}  // namespace

Bvh build_sah(std::span<const Triangle> triangles, const SahConfig& config) {
  const Threads threads(config.threads);
  std::vector<Node> leaves = make_leaves(triangles, threads);
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(leaves.size());
  if (leaves.empty()) return bvh;
  bvh.nodes.resize(2 * leaves.size() - 1);
  SharedSplits(leaves, bvh.nodes, centre_scale(bounds_of(leaves, threads)), threads).build();
  return bvh;
}

}  // namespace coppice
