#include "twins/ploc_rounds.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <tuple>

namespace coppice::twins {

PlocRound make_round(uint cluster_count, uint merged_before, bool pair_all) {
  PlocRound round{};
  round.cluster_count = cluster_count;
  round.merged_before = merged_before;
  round.pair_all = pair_all;
  if (cluster_count > PLOC_FINISH_CLUSTERS) {
    round.merge_groups = {(cluster_count - 1) / PLOC_MERGE_TILE + 1, 1, 1};
    round.tile_scan_groups = {1, 1, 1};
  }
  return round;
}

PlocRound round_after(uint index, const PlocRound& round, uint merged) {
  const uint left = round.cluster_count - merged;
  const std::uint64_t active_count = std::uint64_t{left} + round.merged_before + merged;
  const bool behind = std::uint64_t{left} << ((index + 1) / PLOC_EPOCH_ROUNDS) > active_count;
  const bool slow = std::uint64_t{merged} * PLOC_SLOW_ROUND < round.cluster_count;
  return make_round(left, round.merged_before + merged, behind || slow);
}

Node make_parent(const Node& left, const Node& right, uint first_child) {
  Node parent{left.box_min, first_child, left.box_max, std::max(left.height, right.height) + 1};
  for (int axis = 0; axis < 3; ++axis) {
    parent.box_min[axis] = std::min(parent.box_min[axis], right.box_min[axis]);
    parent.box_max[axis] = std::max(parent.box_max[axis], right.box_max[axis]);
  }
  return parent;
}

uint children_place(uint active_count, uint rank) { return 2 * (active_count - 1 - rank) - 1; }

uint nearest_neighbour(const Aabb* normalised_boxes, uint i, uint cluster_count, uint radius) {
  // Smaller is nearer: area, gap, whether the pair's lower index has the lowest bit of the gap set.
  using Rank = std::tuple<float, uint, bool>;
  const uint first = i - std::min(i, radius);
  const uint last = std::min(i + radius, cluster_count - 1);
  Rank best_rank;
  uint best = i;
  for (uint j = first; j <= last; ++j) {
    if (j == i) continue;
    const uint lower = std::min(i, j), gap = std::max(i, j) - lower;
    const bool odd = (lower >> std::countr_zero(gap) & 1) != 0;
    const Rank rank(union_area(normalised_boxes[i], normalised_boxes[j]), gap, odd);
    if (best == i || rank < best_rank) {
      best_rank = rank;
      best = j;
    }
  }
  return best;
}

std::vector<uint> find_neighbours(std::span<const Node> clusters, bool pair_all, uint radius,
                                  const Normalisation& normalise) {
  const auto count = static_cast<uint>(clusters.size());
  std::vector<Aabb> boxes;
  for (const Node& cluster : clusters)
    boxes.push_back({normalise(cluster.box_min), normalise(cluster.box_max)});
  std::vector<uint> nearest;
  for (uint i = 0; i < count; ++i) {
    const uint partner = i % 2 == 1 ? i - 1 : i + 1 < count ? i + 1 : i;
    nearest.push_back(pair_all ? partner : nearest_neighbour(boxes.data(), i, count, radius));
  }
  return nearest;
}

}  // namespace coppice::twins
