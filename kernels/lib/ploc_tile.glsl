// Whom each cluster of a tile merges with, found by one subgroup.
//
// The subgroup goes over the list in blocks. Those that the clusters of the current one may merge with are in registers,
// and what the clusters about it have chosen.
//
// The including kernel defines RADIUS, a specialization constant, how the tree's box is normalised, and where clusters and
// partners are kept:
#include "lib/ploc_meet.glsl"
Normalisation tree_normalisation();
Node load_cluster(uint i);
void keep_partner(uint i, uint partner);

Block load_block(uint i, uint cluster_count, Normalisation normalisation) {
  Block block = Block(Box(vec3(-FAR), vec3(FAR)), Nearest(NO_AREA, 0u));
  if (i < cluster_count) {
    Node cluster = load_cluster(i);
    block.box = Box(normalised(cluster.box_min, normalisation), normalised(cluster.box_max, normalisation));
  }
  return block;
}

// How far in the list the nearest neighbours are, of a block and those about it.
const uint CHOICE_BLOCKS = 2u * BLOCKS_AHEAD + 1u;

struct Choices {
  int blocks[CHOICE_BLOCKS];
};

// That of the cluster `to` places behind the first.
int choice_of(uint to, Choices choices) {
  int found = 0;
  [[unroll]] for (uint k = 0u; k <= 2u * BLOCKS_AHEAD; ++k) {
    int choice = subgroupShuffle(choices.blocks[k], to % LANES);
    found = to / LANES == k ? choice : found;
  }
  return found;
}

// Of a mutual pair the lower index takes in the upper one, which retires. Returns what they count: clusters that retire,
// and, 16 bits higher, pairs that merge.
uint count_fate(uint i, int choice, bool mutual, bool keep) {
  bool retires = mutual && choice < 0, merges = mutual && choice > 0;
  if (keep) keep_partner(i, retires ? PLOC_RETIRES : merges ? i + uint(choice) : i);
  return retires ? 1u : merges ? 0x10000u : 0u;
}

// The lane's part of the tile's sums; keeps the partners if asked.
uint search_tile(uint first, uint last, uint cluster_count, bool keep) {
  Normalisation normalisation = tree_normalisation();
  const uint halo = BLOCKS_AHEAD * LANES;
  uint lead = first == 0u ? 0u : 2u * halo;  // a choice depends on `halo` clusters before it, a pair on two choices
  uint sums = 0u;
  uint i = first - lead + lane();
  Choices choices;
  Blocks blocks;
  [[unroll]] for (uint k = 0u; k <= BLOCKS_AHEAD; ++k) {
    blocks.at[k] = load_block(i + k * LANES, cluster_count, normalisation);
    choices.blocks[k] = choices.blocks[k + BLOCKS_AHEAD] = 0;
  }
  uint block_count = (last - first + lead + LANES - 1u) / LANES + BLOCKS_AHEAD;
  [[dont_unroll]] for (uint block = 0u; block < block_count; ++block) {
    Block coming = load_block(i + halo + LANES, cluster_count, normalisation);
    uint nearest = meet_blocks(i, blocks);
    [[unroll]] for (uint k = 0u; k < 2u * BLOCKS_AHEAD; ++k) choices.blocks[k] = choices.blocks[k + 1u];
    choices.blocks[2u * BLOCKS_AHEAD] = int(nearest - i);
    int choice = choices.blocks[BLOCKS_AHEAD];
    int answer = choice_of(halo + lane() + uint(choice), choices);
    bool mutual = choice != 0 && answer == -choice;
    if (block * LANES >= lead + halo && i - halo < last) sums += count_fate(i - halo, choice, mutual, keep);
    drop_first(blocks);
    blocks.at[BLOCKS_AHEAD] = coming;
    i += LANES;
  }
  return sums;
}

uint pair_tile(uint first, uint last, uint cluster_count, bool keep) {
  uint sums = 0u;
  [[dont_unroll]] for (uint i = first + lane(); i < last; i += LANES) {
    int choice = int(paired_with(i, cluster_count) - i);
    sums += count_fate(i, choice, choice != 0, keep);
  }
  return sums;
}

// Returns the tile's sums: clusters that retire, pairs that merge. Keeps the partners of its clusters if asked.
uvec2 find_partners(uint tile, PlocRound round, bool keep) {
  uint first = tile * PLOC_MERGE_TILE, last = min(first + PLOC_MERGE_TILE, round.cluster_count);
  uint sums = round.pair_all != 0u ? pair_tile(first, last, round.cluster_count, keep)
                                   : search_tile(first, last, round.cluster_count, keep);
  sums = subgroupAdd(sums);
  return uvec2(sums & 0xffffu, sums >> 16);
}
