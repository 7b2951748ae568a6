// PLOC: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
// Construction", 2018.
#ifndef COPPICE_INTERFACE_PLOC_H
#define COPPICE_INTERFACE_PLOC_H
#include "lookback.h"
INTERFACE_BEGIN

const uint PLOC_MAX_RADIUS = 100;
// Two rules bound the rounds, see docs/numerics.md; scenes as people make them do not meet either.
// Round t pairs all clusters, whatever their distance, if more are left than active_count >> (t /
// PLOC_EPOCH_ROUNDS); and if the round before it merged fewer than 1 / PLOC_SLOW_ROUND of its clusters.
const uint PLOC_EPOCH_ROUNDS = 12;
const uint PLOC_SLOW_ROUND = 128;

const uint PLOC_LEAVES_GROUP = 64;
const uint PLOC_LEAVES_PER_INVOCATION = 16;
const uint PLOC_LEAVES_TILE = PLOC_LEAVES_GROUP * PLOC_LEAVES_PER_INVOCATION;

// What one workgroup, a single subgroup, searches and merges; an even number, so that pairs of a round that
// pairs all do not lie in two tiles.
const uint PLOC_MERGE_TILE = 1024;
const uint PLOC_MERGE_SUMS = 2;  // scanned together: clusters that retire, pairs that merge
const uint PLOC_RETIRES = 0xffffffff;
const uint PLOC_TILE_SCAN_GROUP = 64;

// From here on one subgroup does all remaining rounds: as many as 32 KiB of shared memory hold, with 36 bytes
// each, in multiples of 64.
const uint PLOC_FINISH_CLUSTERS = 896;

// One round, written by the last tile of the round before it. Zero for a round that is not needed.
struct PlocRound {
  uint cluster_count;
  uint merged_before;  // pairs merged in all earlier rounds
  uint pair_all;       // 1: cluster 2i merges with 2i + 1, whatever their distance
  uint ticket;         // tile tickets of this round's merge
  uvec3 merge_groups;  // indirect dispatch of this round; zero when the finish takes over
  // Without lookback one more workgroup scans the tiles.
  uvec3 tile_scan_groups;
  uint padding0, padding1;
};

INTERFACE_BUFFER(PlocRoundBuffer, PlocRound, 16)

struct PlocLeavesArgs {
  READS(AabbBuffer) boxes;        // triangle_count
  READS(UintBuffer) values;       // triangle indices in Morton order, active ones first
  NodeBuffer clusters;            // active_count leaves, in Morton order
  READS(BuildStateBuffer) state;  // active_count
  PlocRoundBuffer rounds;         // the first one is written
  uint triangle_count;
  uint padding;
};

struct PlocMergeArgs {
  READS(NodeBuffer) clusters_in;
  NodeBuffer clusters_out;
  UintBuffer
      partners;  // a cluster: whom it merges with; itself; or PLOC_RETIRES, where another merges with it
  CoherentUintBuffer
      tile_status;  // tiles * PLOC_MERGE_SUMS; without lookback, sums of each tile, then their prefixes
  UintBuffer next_status;  // the tile_status of the next round: cleared
  NodeBuffer nodes;        // 2 * active_count - 1
  BuildStateBuffer state;
  PlocRoundBuffer rounds;
  uint round;
  uint lookback;  // 1: tile prefixes by lookback; 0: from ploc_tile_counts and ploc_tile_scan
  uint radius;    // for the twins: in the kernels the constant RADIUS
  uint padding;
};

struct PlocTileScanArgs {
  CoherentUintBuffer tile_status;  // sums of the tiles, replaced by their exclusive sums over the tiles
  PlocRoundBuffer rounds;
  uint round;
  uint padding;
};

struct PlocFinishArgs {
  NodeBuffer clusters_even;  // clusters of the even rounds
  NodeBuffer clusters_odd;
  NodeBuffer nodes;
  BuildStateBuffer state;
  PlocRoundBuffer rounds;
  uint radius;
  uint rounds_bound;
};

struct PlocMergeConstants {
  LookbackConstants lookback;
  uint radius;
};

struct PlocFinishConstants {
  uint radius;
};

INTERFACE_END
#endif
