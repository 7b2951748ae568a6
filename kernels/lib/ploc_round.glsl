// What the next round looks like, given how many pairs this one merged. Both the rounds in dispatches and the rounds
// of the finish are chained by it.

uint tiles(uint cluster_count, uint tile) { return (cluster_count + tile - 1u) / tile; }

PlocRound planned_round(uint cluster_count, uint merged_before, bool pair_all) {
  bool dispatched = cluster_count > PLOC_FINISH_CLUSTERS;
  uvec3 merge_groups = uvec3(tiles(cluster_count, PLOC_MERGE_TILE), 1u, 1u);
  return PlocRound(cluster_count, merged_before, pair_all ? 1u : 0u, 0u,
                   dispatched ? merge_groups : uvec3(0u), dispatched ? uvec3(1u) : uvec3(0u), 0u, 0u);
}

PlocRound round_after(uint round_index, uint cluster_count, uint merged_before, uint merged) {
  uint active_count = cluster_count + merged_before;
  bool behind = cluster_count - merged > active_count >> ((round_index + 1u) / PLOC_EPOCH_ROUNDS);
  bool slow = merged < (cluster_count + PLOC_SLOW_ROUND - 1u) / PLOC_SLOW_ROUND;
  return planned_round(cluster_count - merged, merged_before + merged, behind || slow);
}

// In a round that pairs all clusters the partner is fixed; the last of an odd number has none but itself.
uint paired_with(uint i, uint cluster_count) {
  return (i ^ 1u) < cluster_count ? i ^ 1u : i;
}

// The pair that is the rank-th of the whole build takes the nodes 2 k + 1 and 2 k + 2, k counted down to the root's.
uint first_child_of(uint active_count, uint rank) { return 2u * (active_count - 2u - rank) + 1u; }

Node parent_of(Node left, Node right, uint first_child) {
  return Node(min(left.box_min, right.box_min), first_child, max(left.box_max, right.box_max),
              1u + max(left.height, right.height));
}
