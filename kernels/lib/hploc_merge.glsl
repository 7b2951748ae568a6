// Rounds of PLOC over a list, by one subgroup in shared memory.

void find_all_pairs(List its) {
  [[dont_unroll]] for (uint i = lane(); i < its.count; i += LANES)
    nearest[i] = list[its.base + i] | paired_with(i, its.count) << 16;
}

// A cluster of an LBVH is nearest to the one beyond the lower of the splits at its ends: its sibling or, as long as
// that is not complete, a part of it.
void find_siblings(List its) {
  [[dont_unroll]] for (uint i = lane(); i < its.count; i += LANES) {
    uint slot = list[its.base + i];
    uint before = levels[slot] & 0xffu;
    uint behind = i + 1u < its.count ? levels[list[its.base + i + 1u]] & 0xffu : HPLOC_END_LEVEL;
    nearest[i] = slot | (i == 0u || behind < before ? i + 1u : i - 1u) << 16;
  }
}

// Lists the pairs of clusters that are nearest to each other, and takes the upper ones out of the list. Returns how
// many pairs there are.
uint find_pairs(List its) {
  uint pair_count = 0u, retired = 0u;
  [[dont_unroll]] for (uint first = 0u; first < its.count; first += LANES) {
    uint i = first + lane();
    bool present = i < its.count;
    uint its_word = nearest[present ? i : 0u];
    uint j = its_word >> 16, slot = its_word & 0xffffu;
    uint partner_word = nearest[j];
    bool mutual = present && j != i && partner_word >> 16 == i;
    bool merges = mutual && i < j, retires = mutual && j < i;
    uint word = retires ? 1u : merges ? 0x10000u : 0u;
    uint sums = inclusive_add(word);
    uint before = sums - word;
    if (merges) pairs[pair_count + (before >> 16)] = slot | partner_word << 16;
    if (present && !retires) list[its.base + i - retired - (before & 0xffffu)] = slot;
    uint block_sums = subgroupBroadcast(sums, LANES - 1u);
    pair_count += block_sums >> 16;
    retired += block_sums & 0xffffu;
  }
  return pair_count;
}

// Merges the clusters of a list until at most `target` are left; returns how many are. Every round merges at least one
// pair.
uint merge_list(List its, uint target, bool tall, Normalisation normalisation) {
  bool pair_all = tall;
  [[dont_unroll]] for (uint round = 0u; round < HPLOC_TILE && its.count > target; ++round) {
    if (pair_all) find_all_pairs(its);
    else if (CLUSTER_LIMIT == 1u) find_siblings(its);
    else find_nearest_boxes(its, normalisation);
    sync();
    uint pair_count = find_pairs(its);
    sync();
    join_pairs(pair_count, its);
    sync();
    pair_all = CLUSTER_LIMIT != 1u && (tall || pair_count * HPLOC_SLOW_ROUND < its.count);
    its.count -= pair_count;
  }
  return its.count;
}
