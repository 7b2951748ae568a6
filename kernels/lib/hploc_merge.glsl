// Merging the clusters of a node of the radix tree: rounds of PLOC over a list of at most HPLOC_LIST clusters, by one
// subgroup in shared memory.
//
// A cluster has a slot, which holds its node, and a name, the first place that it took. Of two that merge the first
// keeps slot and name, and the name j of the other, never 0, gives the pair its place: 2j - 1 and 2j.

shared Node clusters[HPLOC_TILE];  // by slot
shared uint names[HPLOC_TILE];     // by slot
shared uint list[HPLOC_TILE];      // slots
shared uint nearest[HPLOC_LIST];   // indices into the list

uint lane() { return gl_SubgroupInvocationID; }
uint lanes() { return gl_SubgroupSize; }

// All reads of the subgroup behind see all writes to shared memory before. A barrier costs CPU devices as much as twenty
// loads.
void sync() {
  if (LANES_IN_STEP) memoryBarrierShared();
  else subgroupBarrier();
}

// Of the clusters in slots a and b; the parent takes slot a.
void join_slots(uint a, uint b) {
  uint first_child = 2u * names[b] - 1u;
  Node left = clusters[a], right = clusters[b];
  args.nodes.at[first_child] = left;
  args.nodes.at[first_child + 1u] = right;
  clusters[a] = parent_of(left, right, first_child);
}

void find_neighbours(uint count, bool pair_all) {
  [[dont_unroll]] for (uint i = lane() * PLOC_RUN; i < count; i += lanes() * PLOC_RUN) {
    uint found[PLOC_RUN];
    if (!pair_all) find_nearest(i, i, count, min(args.radius, count - 1u), found);
    [[unroll]] for (uint k = 0u; k < PLOC_RUN; ++k) {
      if (i + k < count) nearest[i + k] = pair_all ? paired_with(i + k, count) : found[k];
    }
  }
  sync();
}

// One round over the list from `base` on. Returns how many clusters are left, at least one less.
uint merge_round(uint base, uint count, bool pair_all) {
  find_neighbours(count, pair_all);
  uint retiring = 0u;
  [[dont_unroll]] for (uint i = lane(); i < count; i += lanes()) {
    uint j = nearest[i];
    if (j < i && nearest[j] == i) retiring |= 1u << i;
  }
  uint retired = subgroupOr(retiring);
  // In ascending steps: places are no greater than indices, and no step reads what is behind it.
  [[dont_unroll]] for (uint first = 0u; first < count; first += lanes()) {
    uint i = first + lane();
    bool stays = i < count && bitfieldExtract(retired, int(i), 1) == 0u;
    uint slot = 0u;
    vec4 low = vec4(0.0);
    vec2 high = vec2(0.0);
    if (stays) {
      uint j = nearest[i];
      slot = list[base + i];
      low = tile_min_and_max_x[i];
      high = tile_max_yz[i];
      if (j > i && nearest[j] == i) {
        join_slots(slot, list[base + j]);
        low = vec4(min(low.xyz, tile_min_and_max_x[j].xyz), max(low.w, tile_min_and_max_x[j].w));
        high = max(high, tile_max_yz[j]);
      }
    }
    sync();
    if (stays) {
      uint place = i - uint(bitCount(retired & ((1u << i) - 1u)));
      list[base + place] = slot;
      tile_min_and_max_x[place] = low;
      tile_max_yz[place] = high;
    }
    sync();
  }
  return count - uint(bitCount(retired));
}

// Merges the list of `count` clusters from `base` on until at most `target` are left; returns how many are. Every round
// merges at least one pair, so there are never more than HPLOC_LIST rounds.
uint merge_list(uint base, uint count, uint target, Normalisation normalisation) {
  if (count <= target) return count;
  if (count == 2u) {
    if (lane() == 0u) join_slots(list[base], list[base + 1u]);
    sync();
    return 1u;
  }
  bool tall = false;
  [[dont_unroll]] for (uint i = lane(); i < count; i += lanes()) {
    Node cluster = clusters[list[base + i]];
    cache_box(i, cluster, normalisation);
    tall = tall || cluster.height >= HPLOC_TALL;
  }
  bool pair_all = subgroupAny(tall);
  sync();
  [[dont_unroll]] for (uint round = 0u; round < HPLOC_LIST && count > target; ++round)
    count = merge_round(base, count, pair_all);
  return count;
}
