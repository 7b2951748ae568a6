#include "builders/ploc_clustering.h"

#include <algorithm>
#include <utility>

#include "builders/subtree.h"

namespace coppice {
namespace {

// Clusters that a thread takes at a time.
constexpr std::size_t PLOC_CHUNK = 16 * ClusterBoxes::TILE;

}  // namespace

PlocClustering::PlocClustering(MortonLeaves leaves, std::uint32_t radius, const Threads& threads)
    : threads_(threads),
      count_(leaves.count()),
      clusters_(count_),
      boxes_(count_, radius),
      next_boxes_(0, radius),
      nearest_(std::make_unique_for_overwrite<std::uint32_t[]>(count_)) {
  threads.for_each_chunk(count_, PLOC_CHUNK, [&](Chunk chunk, std::size_t) {
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      const Node& leaf = leaves.leaf(i);
      clusters_[i] = leaf;
      boxes_.set(i, leaves.to_normalised(Aabb{leaf.box_min, leaf.box_max}));
    }
  });
  next_clusters_ = std::move(leaves.leaves);
  leaves = MortonLeaves{{}, {}, {}, leaves.to_normalised};  // gives its memory back
  next_boxes_ = ClusterBoxes(count_, radius);
  nodes_.resize(2 * count_ - 1);
  next_child_ = nodes_.size();
}

std::size_t PlocClustering::merge_nearest() {
  threads_.for_each_chunk(count_, PLOC_CHUNK, [&](Chunk chunk, std::size_t) {
    boxes_.find_nearest(chunk, {nearest_.get(), count_});
  });
  return merge_mutual();
}

std::size_t PlocClustering::merge_pairs() {
  for (std::size_t i = 0; i < count_; ++i) nearest_[i] = static_cast<std::uint32_t>(i ^ 1);
  if (count_ % 2 == 1) nearest_[count_ - 1] = static_cast<std::uint32_t>(count_ - 1);
  return merge_mutual();
}

std::vector<Node> PlocClustering::take_nodes() {
  nodes_[0] = clusters_[0];
  return std::move(nodes_);
}

std::size_t PlocClustering::merge_mutual() {
  std::vector<MergeCounts> before(chunk_count(count_, PLOC_CHUNK));
  threads_.for_each_chunk(count_, PLOC_CHUNK,
                          [&](Chunk chunk, std::size_t k) { before[k] = count_merges(chunk); });
  MergeCounts sum;
  for (MergeCounts& counts : before) {
    const MergeCounts own = std::exchange(counts, sum);
    sum.retired += own.retired;
    sum.merged += own.merged;
  }
  threads_.for_each_chunk(count_, PLOC_CHUNK,
                          [&](Chunk chunk, std::size_t k) { merge_chunk(chunk, before[k]); });
  next_child_ -= 2 * sum.merged;
  count_ -= sum.retired;
  next_boxes_.shrink(count_);
  std::swap(clusters_, next_clusters_);
  std::swap(boxes_, next_boxes_);
  return sum.merged;
}

PlocClustering::MergeCounts PlocClustering::count_merges(Chunk chunk) const {
  MergeCounts counts;
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    const bool is_in_pair = is_mutual(i);
    counts.retired += is_in_pair & (nearest_[i] < i);
    counts.merged += is_in_pair & (nearest_[i] > i);
  }
  return counts;
}

// A merged cluster takes the place of its first part; pairs get their nodes in the order of their first
// parts.
void PlocClustering::merge_chunk(Chunk chunk, const MergeCounts& before) {
  std::size_t place = chunk.begin - before.retired;
  std::size_t next_child = next_child_ - 2 * before.merged;
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    const std::size_t j = nearest_[i];
    if (!is_mutual(i)) {
      next_clusters_[place] = clusters_[i];
      next_boxes_.copy(place++, boxes_, i);
    } else if (i < j) {
      next_child -= 2;
      nodes_[next_child] = clusters_[i];
      nodes_[next_child + 1] = clusters_[j];
      Node& parent = next_clusters_[place];
      parent.child = static_cast<std::uint32_t>(next_child);
      fit_to_children(parent, nodes_);
      next_boxes_.merge(place++, boxes_, i, j);
    }
  }
}

}  // namespace coppice
