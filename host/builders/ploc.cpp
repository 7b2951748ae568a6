#include "builders/ploc.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "builders/leaves.h"
#include "builders/morton_order.h"
#include "builders/normalised_space.h"
#include "builders/ploc_neighbours.h"

namespace coppice {
namespace {

void require_valid(const PlocConfig& config) {
  if (config.radius < 1 || config.radius > PLOC_MAX_RADIUS) {
    throw std::invalid_argument("PLOC radius " + std::to_string(config.radius) + " is not in 1 to " +
                                std::to_string(PLOC_MAX_RADIUS));
  }
  if (config.morton_bits != 30 && config.morton_bits != 60) {
    throw std::invalid_argument("Morton codes of " + std::to_string(config.morton_bits) +
                                " bits: there are 30 and 60");
  }
}

Node parent_of(const Node& first, const Node& second, std::uint32_t child) {
  const Aabb box = box_union({first.box_min, first.box_max}, {second.box_min, second.box_max});
  return {box.box_min, child, box.box_max, 1 + std::max(first.height, second.height)};
}

template <class T>
std::vector<T> in_order(const std::vector<T>& values, std::span<const std::uint32_t> order) {
  std::vector<T> ordered;
  ordered.reserve(order.size());
  for (const std::uint32_t i : order) ordered.push_back(values[i]);
  return ordered;
}

// The state between rounds: clusters in order, in world units, and their boxes in normalised space.
class Clustering {
 public:
  Clustering(std::vector<Node> leaves, std::span<const Aabb> boxes, std::uint32_t radius)
      : clusters_(std::move(leaves)), boxes_(boxes, radius), nearest_(clusters_.size()) {
    nodes_.resize(2 * clusters_.size() - 1);
    next_child_ = static_cast<std::uint32_t>(nodes_.size()) - 2;
  }

  std::size_t count() const { return clusters_.size(); }

  // One round by distance. Returns the number of pairs merged, at least 1; needs at least two clusters.
  std::size_t merge_nearest() {
    boxes_.find_nearest(nearest_);
    return merge_mutual();
  }

  // One round in which each cluster of even position merges with the next one.
  std::size_t merge_pairs() {
    for (std::size_t i = 0; i < count(); ++i) nearest_[i] = static_cast<std::uint32_t>(i ^ 1);
    if (count() % 2 == 1) nearest_[count() - 1] = static_cast<std::uint32_t>(count() - 1);
    return merge_mutual();
  }

  // Once one cluster is left.
  std::vector<Node> take_nodes() {
    nodes_[0] = clusters_[0];
    return std::move(nodes_);
  }

 private:
  // A merged cluster takes the place of its first part. Both arrays are compacted in place: no place is
  // written before it has been read.
  std::size_t merge_mutual() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count(); ++i) {
      const std::size_t j = nearest_[i];
      const bool is_mutual = j != i && nearest_[j] == i;
      if (!is_mutual) {
        clusters_[kept] = clusters_[i];
        boxes_.move(kept++, i);
      } else if (i < j) {
        nodes_[next_child_] = clusters_[i];
        nodes_[next_child_ + 1] = clusters_[j];
        clusters_[kept] = parent_of(clusters_[i], clusters_[j], next_child_);
        boxes_.merge(kept++, i, j);
        next_child_ -= 2;
      }
    }
    const std::size_t merged = count() - kept;
    clusters_.resize(kept);
    boxes_.shrink(kept);
    return merged;
  }

  std::vector<Node> clusters_;
  ClusterBoxes boxes_;
  std::vector<std::uint32_t> nearest_;
  std::vector<Node> nodes_;
  std::uint32_t
      next_child_;  // pairs of siblings fill the nodes from the back, the last merge just below the root
};

}  // namespace

Bvh build_ploc(std::span<const Triangle> triangles, const PlocConfig& config) {
  require_valid(config);
  Bvh bvh;
  const std::vector<Node> leaves = make_leaves(triangles);
  bvh.active_count = static_cast<std::uint32_t>(leaves.size());
  if (leaves.empty()) return bvh;

  const NormalisedSpace to_normalised(bounds_of(leaves));
  std::vector<Aabb> boxes;
  boxes.reserve(leaves.size());
  for (const Node& leaf : leaves) boxes.push_back(to_normalised(Aabb{leaf.box_min, leaf.box_max}));
  const int bits_per_axis = static_cast<int>(config.morton_bits) / 3;
  const auto order = sorted_order(morton_codes(boxes, bits_per_axis), static_cast<int>(config.morton_bits));

  Clustering clustering(in_order(leaves, order), in_order(boxes, order), config.radius);
  bool pairing = false;
  while (clustering.count() > 1) {
    const std::size_t count = clustering.count();
    const std::size_t merged = pairing ? clustering.merge_pairs() : clustering.merge_nearest();
    ++bvh.rounds;
    const bool behind =
        std::uint64_t{clustering.count()} << bvh.rounds / PLOC_EPOCH_ROUNDS > bvh.active_count;
    pairing = behind || merged * PLOC_SLOW_ROUND < count;
  }
  bvh.nodes = clustering.take_nodes();
  return bvh;
}

}  // namespace coppice
