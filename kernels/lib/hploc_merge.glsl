// Merging the clusters of a node of the radix tree: rounds of PLOC over a list of at most HPLOC_LIST clusters, by one
// subgroup in shared memory.
//
// A cluster has a slot, which holds its node, and a name, the first place that it took. Of two that merge the first
// keeps slot and name, and the name j of the other, never 0, gives the pair its place: 2j - 1 and 2j.

const uint NODE_WORDS = 8u;  // of a Node: box_min, child, box_max, height
shared uint cluster_words[HPLOC_TILE * NODE_WORDS];  // nodes by slot
shared uint names[HPLOC_TILE];     // by slot
shared uint list[HPLOC_TILE];      // slots
shared uint nearest[HPLOC_LIST];   // indices into the list

// Strips of a list, as long as the subgroup is wide.
const uint STRIPS = (HPLOC_LIST + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
shared float left_area[64];  // of the nearest neighbour before each cluster of the list
shared uint left_gap[64];
shared uvec2 pair_slots[HPLOC_CLUSTERS];

uint lane() { return gl_SubgroupInvocationID; }
uint lanes() { return gl_SubgroupSize; }

// Merges the clusters of a pair of slots, but only one word of their nodes: all words of all pairs are done at once.
void join_word(uvec2 pair, uint word) {
  uint left = cluster_words[pair.x * NODE_WORDS + word], right = cluster_words[pair.y * NODE_WORDS + word];
  uint first_child = 2u * names[pair.y] - 1u;
  UintBuffer node_words = UintBuffer(args.nodes);
  node_words.at[first_child * NODE_WORDS + word] = left;
  node_words.at[(first_child + 1u) * NODE_WORDS + word] = right;
  bool right_smaller = uintBitsToFloat(right) < uintBitsToFloat(left);
  bool takes_right = word < 4u ? right_smaller : !right_smaller;
  uint parent = takes_right ? right : left;
  if (word == 3u) parent = first_child;
  if (word == 7u) parent = 1u + max(left, right);
  cluster_words[pair.x * NODE_WORDS + word] = parent;
}

void join_pairs(uint pair_count) {
  [[dont_unroll]] for (uint i = lane(); i < pair_count * NODE_WORDS; i += lanes())
    join_word(pair_slots[i / NODE_WORDS], i % NODE_WORDS);
}

uint list_index(uint strip) { return strip * gl_WorkGroupSize.x + lane(); }

// A cluster on its way past the others, with its nearest neighbour among those before it.
struct Traveller {
  Box box;
  Nearest left;
};

Traveller next_lane(Traveller t) {
  uint from = (lane() + 1u) % gl_WorkGroupSize.x;
  return Traveller(Box(subgroupShuffle(t.box.box_min, from), subgroupShuffle(t.box.box_max, from)),
                   Nearest(subgroupShuffle(t.left.area, from), subgroupShuffle(t.left.gap, from)));
}

Traveller select(bool second, Traveller a, Traveller b) {
  bvec3 s = bvec3(second);
  return Traveller(Box(mix(a.box.box_min, b.box.box_min, s), mix(a.box.box_max, b.box.box_max, s)),
                   Nearest(second ? b.left.area : a.left.area, second ? b.left.gap : a.left.gap));
}

// A list in registers. Cluster i is in strip i / S of lane i mod S, where S is the size of the subgroup.
struct ListLanes {
  uint slots[STRIPS];
  uint nearest[STRIPS];  // indices into the list
};

// The box of a cluster of the list, or one that is nearest to nothing.
Box box_of(uint slot, bool present, Normalisation normalisation) {
  if (!present) return Box(vec3(-FAR), vec3(FAR));
  uint first = slot * NODE_WORDS;
  uvec3 low = uvec3(cluster_words[first], cluster_words[first + 1u], cluster_words[first + 2u]);
  uvec3 high = uvec3(cluster_words[first + 4u], cluster_words[first + 5u], cluster_words[first + 6u]);
  return Box(normalised(uintBitsToFloat(low), normalisation), normalised(uintBitsToFloat(high), normalisation));
}

// The list turns by one place a step past a copy of itself, so each pair is met once, and gaps come in ascending order
// on both sides.
void find_nearest_in_list(inout ListLanes its, uint count, uint radius, Normalisation normalisation) {
  Box own[STRIPS];
  Nearest right[STRIPS];
  Traveller travellers[STRIPS];
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    own[k] = box_of(its.slots[k], list_index(k) < count, normalisation);
    right[k] = Nearest(NO_AREA, 0u);
    travellers[k] = Traveller(own[k], right[k]);
  }
  bool is_last = lane() + 1u == gl_WorkGroupSize.x;
  [[dont_unroll]] for (uint gap = 1u; gap <= radius; ++gap) {
    [[unroll]] for (uint k = 0u; k < STRIPS; ++k) travellers[k] = next_lane(travellers[k]);
    Traveller wrapped = travellers[0];
    [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
      if (k + 1u < STRIPS) travellers[k] = select(is_last, travellers[k], travellers[k + 1u]);
      else travellers[k] = select(is_last, travellers[k], wrapped);
      float area = union_area(own[k], travellers[k].box);
      bool met = list_index(k) + gap < count;
      bool right_nearer = met && area < right[k].area, left_nearer = met && area < travellers[k].left.area;
      right[k].area = right_nearer ? area : right[k].area;
      right[k].gap = right_nearer ? gap : right[k].gap;
      travellers[k].left.area = left_nearer ? area : travellers[k].left.area;
      travellers[k].left.gap = left_nearer ? gap : travellers[k].left.gap;
    }
  }
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    uint home = (list_index(k) + radius) % (STRIPS * gl_WorkGroupSize.x);
    left_area[home] = travellers[k].left.area;
    left_gap[home] = travellers[k].left.gap;
  }
  sync();
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    uint i = list_index(k);
    its.nearest[k] = nearer_side(i, Nearest(left_area[i], left_gap[i]), right[k]);
  }
}

// Bit i: cluster i is the lower one of a pair, or the upper one.
struct Fates {
  uint merging, retiring;
};

Fates find_fates(ListLanes its, uint count) {
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    if (list_index(k) < count) nearest[list_index(k)] = its.nearest[k];
  }
  sync();
  Fates fates = Fates(0u, 0u);
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    uint i = list_index(k), j = its.nearest[k];
    if (i < count && j != i && nearest[j] == i) {
      fates.merging |= i < j ? 1u << i : 0u;
      fates.retiring |= j < i ? 1u << i : 0u;
    }
  }
  return Fates(subgroupOr(fates.merging), subgroupOr(fates.retiring));
}

uint bits_before(uint bits, uint i) { return uint(bitCount(bits & ((1u << i) - 1u))); }

// One round over the list from `base` on. Returns how many clusters are left, at least one less.
uint merge_round(uint base, uint count, bool pair_all, Normalisation normalisation) {
  ListLanes its;
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    its.slots[k] = list_index(k) < count ? list[base + list_index(k)] : 0u;
    its.nearest[k] = paired_with(list_index(k), count);
  }
  if (!pair_all) find_nearest_in_list(its, count, min(args.radius, count - 1u), normalisation);
  Fates fates = find_fates(its, count);
  // Pairs side by side, so that few lanes idle.
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    uint i = list_index(k);
    if (i < count && bitfieldExtract(fates.merging, int(i), 1) != 0u)
      pair_slots[bits_before(fates.merging, i)] = uvec2(its.slots[k], list[base + its.nearest[k]]);
  }
  sync();
  join_pairs(uint(bitCount(fates.merging)));
  [[unroll]] for (uint k = 0u; k < STRIPS; ++k) {
    uint i = list_index(k);
    if (i < count && bitfieldExtract(fates.retiring, int(i), 1) == 0u)
      list[base + i - bits_before(fates.retiring, i)] = its.slots[k];
  }
  sync();
  return count - uint(bitCount(fates.retiring));
}

// Merges the list of `count` clusters from `base` on until at most `target` are left; returns how many are. Every round
// merges at least one pair, so there are never more than HPLOC_LIST rounds.
uint merge_list(uint base, uint count, uint target, Normalisation normalisation) {
  if (count <= target) return count;
  if (count == 2u) {
    [[dont_unroll]] for (uint word = lane(); word < NODE_WORDS; word += lanes())
      join_word(uvec2(list[base], list[base + 1u]), word);
    sync();
    return 1u;
  }
  bool tall = false;
  [[dont_unroll]] for (uint i = lane(); i < count; i += lanes())
    tall = tall || cluster_words[list[base + i] * NODE_WORDS + 7u] >= HPLOC_TALL;
  bool pair_all = subgroupAny(tall);
  [[dont_unroll]] for (uint round = 0u; round < HPLOC_LIST && count > target; ++round)
    count = merge_round(base, count, pair_all, normalisation);
  return count;
}
