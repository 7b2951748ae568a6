#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "builders/morton_leaves.h"
#include "builders/ploc_neighbours.h"
#include "builders/threads.h"
#include "interface/types.h"

namespace coppice {

// PLOC between its rounds: the clusters in order, in world units, and their boxes in normalised space. What
// comes out does not depend on the number of threads.
class PlocClustering {
 public:
  // At least one leaf; they become the clusters in Morton order.
  PlocClustering(MortonLeaves leaves, std::uint32_t radius, const Threads& threads);

  std::size_t count() const { return count_; }

  // One round by distance. Returns the number of pairs merged, at least 1; needs at least two clusters.
  std::size_t merge_nearest();

  // One round in which each cluster of even position merges with the next one.
  std::size_t merge_pairs();

  // Once one cluster is left.
  std::vector<Node> take_nodes();

 private:
  // Of a chunk of clusters, and then of all chunks before it.
  struct MergeCounts {
    std::size_t retired = 0;  // clusters that give up their place to the first one of their pair
    std::size_t merged = 0;   // pairs whose first cluster is in the chunk
  };

  bool is_mutual(std::size_t i) const { return nearest_[i] != i && nearest_[nearest_[i]] == i; }
  std::size_t merge_mutual();
  MergeCounts count_merges(Chunk chunk) const;
  void merge_chunk(Chunk chunk, const MergeCounts& before);

  const Threads& threads_;
  std::size_t count_;
  // The clusters of a round, and room for those of the next one.
  std::vector<Node> clusters_, next_clusters_;
  ClusterBoxes boxes_, next_boxes_;
  std::unique_ptr<std::uint32_t[]> nearest_;
  std::vector<Node> nodes_;
  // Pairs of siblings fill the nodes from the back, the last merge just below the root.
  std::size_t next_child_;
};

}  // namespace coppice
