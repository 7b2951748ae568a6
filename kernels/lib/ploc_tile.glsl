// One tile of a round's merge: which of its clusters retire, which merge, and how many before each. A subgroup walks
// over consecutive clusters, so ranks follow the order of the list whatever the subgroup's size.

shared uvec2 subgroup_sums[PLOC_MERGE_GROUP];  // retiring, merging; by subgroup

// Of a mutual pair the lower index merges and keeps its place, the upper one retires.
bvec2 retires_merges(uint i, uint cluster_count) {
  if (i >= cluster_count) return bvec2(false);
  uint j = args.nearest.at[i];
  bool mutual = j != i && args.nearest.at[j] == i;
  return bvec2(mutual && j < i, mutual && i < j);
}

uint chunk_first(uint tile) {
  return tile * PLOC_MERGE_TILE + gl_SubgroupID * gl_SubgroupSize * PLOC_MERGE_PER_INVOCATION + gl_SubgroupInvocationID;
}

// The whole workgroup; the sums of the subgroups stay in subgroup_sums. Ends with a barrier.
uvec2 count_tile(uint tile) {
  uint cluster_count = args.rounds.at[args.round].cluster_count;
  uint i = chunk_first(tile);
  uvec2 sums = uvec2(0u);
  [[dont_unroll]] for (uint k = 0u; k < PLOC_MERGE_PER_INVOCATION; ++k, i += gl_SubgroupSize)
    sums += uvec2(retires_merges(i, cluster_count));
  sums = subgroupAdd(sums);
  if (subgroupElect()) subgroup_sums[gl_SubgroupID] = sums;
  barrier();
  uvec2 total = uvec2(0u);
  [[dont_unroll]] for (uint s = 0u; s < gl_NumSubgroups; ++s) total += subgroup_sums[s];
  return total;
}
