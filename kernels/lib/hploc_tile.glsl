// The leaves of a tile, and the greatest nodes of the radix tree that lie within it.
#include "lib/leaf_nodes.glsl"

// A complete node: the places from first to last, and how many clusters are left of them.
struct Range {
  uint first, last, clusters;
};

shared uint ranges[2 * HPLOC_LEVELS];  // first place and clusters, from right to left

const uint LEFT_END = 0x100u;  // beside a level: no split before it in the tile, nor the tile's border, is higher

// The greatest of the lanes up to this one.
uint greatest_up_to(uint value) {
  [[unroll]] for (uint distance = 1u; distance < LANES; distance <<= 1) {
    uint before = subgroupShuffle(value, (lane() - distance) % LANES);
    value = lane() >= distance && before > value ? before : value;
  }
  return value;
}

void load_tile(uint first, uint last, uint place_count) {
  uint count = last - first + 1u, highest = 0u;
  [[dont_unroll]] for (uint at = 0u; at <= count; at += LANES) {
    uint i = at + lane();
    uint level = i <= count ? level_before(first + i, place_count) : 0u;
    uint up_to = max(greatest_up_to(level), highest);
    if (i <= count) levels[i] = level | (level == up_to ? LEFT_END : 0u);
    highest = subgroupBroadcast(up_to, LANES - 1u);
  }
  [[dont_unroll]] for (uint at = lane(); at < count; at += LEAVES_AHEAD * LANES) {
    Node leaves[LEAVES_AHEAD];
    load_leaves(first + at, last + 1u, leaves);
    [[unroll]] for (uint k = 0u; k < LEAVES_AHEAD; ++k) {
      uint i = at + k * LANES;
      if (i < count) {
        cluster_words[i] = words_of(leaves[k]);
        list[i] = i;
      }
    }
  }
  sync();
}

// The nodes whose parents reach over the tile's border end at splits that are higher than all between them and that
// border, the border too. Returns how many there are.
uint find_ranges(uint first, uint last) {
  uint count = last - first + 1u, found = 0u;
  uint highest = levels[count] & 0xffu;
  [[dont_unroll]] for (uint at = 0u; at < count; at += LANES) {
    uint i = count - 1u - at - lane();
    uint word = at + lane() < count ? levels[i] : 0u;
    uint level = word & 0xffu;
    uint up_to = max(greatest_up_to(level), highest);
    bool begins = word != 0u && ((word & LEFT_END) != 0u || level == up_to);
    uint sums = inclusive_add(begins ? 1u : 0u);
    if (begins) ranges[found + sums - 1u] = first + i << HPLOC_ARRIVAL_SHIFT;
    found += subgroupBroadcast(sums, LANES - 1u);
    highest = subgroupBroadcast(up_to, LANES - 1u);
  }
  sync();
  return found;
}

void keep_range(uint i, Range range) {
  if (lane() == 0u) ranges[i] = range.first << HPLOC_ARRIVAL_SHIFT | range.clusters;
  sync();
}

Range range_of(uint i, uint last) {
  uint word = ranges[i];
  uint end = i == 0u ? last : (ranges[i - 1u] >> HPLOC_ARRIVAL_SHIFT) - 1u;
  return Range(word >> HPLOC_ARRIVAL_SHIFT, end, word & (HPLOC_LIST - 1u));
}
