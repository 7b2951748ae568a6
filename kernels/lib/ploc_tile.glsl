// One tile of a round's merge: which of its clusters retire and which merge. A subgroup walks over consecutive
// clusters in PLOC_MERGE_STEPS steps, so ranks follow the order of the list whatever the subgroup's size.

shared uvec2 subgroup_sums[PLOC_MERGE_GROUP];  // retiring, merging; by subgroup

// Bit k: this invocation's cluster in step k. Of a mutual pair the lower index merges and keeps its place, the upper
// one retires.
struct Fates {
  uint retiring, merging;
};

// This invocation's cluster in step 0; the next is gl_SubgroupSize further on.
uint first_cluster(uint tile) {
  return tile * PLOC_MERGE_TILE + gl_SubgroupID * gl_SubgroupSize * PLOC_MERGE_STEPS + gl_SubgroupInvocationID;
}

Fates find_fates(uint tile, uint cluster_count) {
  Fates fates = Fates(0u, 0u);
  uint i = first_cluster(tile);
  [[dont_unroll]] for (uint bit = 1u; i < cluster_count && bit < 1u << PLOC_MERGE_STEPS; bit <<= 1) {
    uint j = args.nearest.at[i];
    if (j != i && args.nearest.at[j] == i) {
      fates.retiring |= j < i ? bit : 0u;
      fates.merging |= j < i ? 0u : bit;
    }
    i += gl_SubgroupSize;
  }
  return fates;
}

// The whole workgroup; ends with a barrier. The sums of the subgroups stay in subgroup_sums.
uvec2 sum_fates(Fates fates) {
  uvec2 sums = subgroupAdd(uvec2(bitCount(fates.retiring), bitCount(fates.merging)));
  if (subgroupElect()) subgroup_sums[gl_SubgroupID] = sums;
  barrier();
  uvec2 total = uvec2(0u);
  [[dont_unroll]] for (uint s = 0u; s < gl_NumSubgroups; ++s) total += subgroup_sums[s];
  return total;
}

// Sums over the subgroups before this one in the tile; after sum_fates.
uvec2 sums_before() {
  uvec2 before = uvec2(0u);
  [[dont_unroll]] for (uint s = 0u; s < gl_SubgroupID; ++s) before += subgroup_sums[s];
  return before;
}
