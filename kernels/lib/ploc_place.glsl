// Merges the pairs of a tile and compacts its clusters, by the subgroup that has found the partners.
//
// The including kernel defines, besides what lib/ploc_tile.glsl asks for:
uint tree_active_count();
void store_tree_node(uint i, Node node);
uint partner_of(uint i);  // as the same lane has kept it
void store_cluster(uint place, Node cluster);  // of the next round
void sync_clusters();  // between loads and stores of a block, where both are of the same list

// Returns the sums up to and with this tile.
uvec2 place_tile(uint tile, PlocRound round, uvec2 before) {
  uint active_count = tree_active_count();
  uint first = tile * PLOC_MERGE_TILE;
  uint count = min(round.cluster_count - first, PLOC_MERGE_TILE);
  [[dont_unroll]] for (uint at = 0u; at < count; at += LANES) {
    uint i = first + at + lane();
    bool present = at + lane() < count;
    uint partner = present ? partner_of(i) : i;
    bool retires = partner == PLOC_RETIRES, merges = !retires && partner != i, stays = present && !retires;
    uint word = retires ? 1u : merges ? 0x10000u : 0u;
    uint sums = inclusive_add(word);
    uvec2 rank = before + uvec2((sums - word) & 0xffffu, (sums - word) >> 16);
    Node cluster, second;
    if (stays) cluster = load_cluster(i);
    if (merges) second = load_cluster(partner);
    sync_clusters();
    if (merges) {
      uint first_child = first_child_of(active_count, round.merged_before + rank.y);
      store_tree_node(first_child, cluster);
      store_tree_node(first_child + 1u, second);
      cluster = parent_of(cluster, second, first_child);
    }
    if (stays) store_cluster(i - rank.x, cluster);
    uint block_sums = subgroupBroadcast(sums, LANES - 1u);
    before += uvec2(block_sums & 0xffffu, block_sums >> 16);
  }
  return before;
}
