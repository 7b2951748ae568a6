// H-PLOC: Benthin, Meister, Barczak, Mehalwal, Tsakok and Kensler, "H-PLOC: Hierarchical Parallel
// Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", 2024.
#ifndef COPPICE_INTERFACE_HPLOC_H
#define COPPICE_INTERFACE_HPLOC_H
#include "types.h"
INTERFACE_BEGIN

// Clusters that a node of the radix tree leaves to its parent, at most. With 1 the result is the radix tree.
const uint HPLOC_CLUSTERS = 16;
const uint HPLOC_LIST = 2 * HPLOC_CLUSTERS;  // clusters of one merge, at most

// Where a cluster of this height is among them all clusters pair, whatever their distance: so heights are
// bounded, see docs/numerics.md.
const uint HPLOC_TALL = 128;
const uint HPLOC_MAX_HEIGHT = 238;  // of any tree

// Where a round merges fewer than 1 / HPLOC_SLOW_ROUND of its clusters the next one pairs all.
const uint HPLOC_SLOW_ROUND = 32;

// What one workgroup, a single subgroup, builds by itself. The tree depends on it: a node of the radix tree
// that lies within a tile, as its parent does, leaves all its clusters to its parent.
const uint HPLOC_TILE = 512;  // places

// A split lies between two places. The deeper in the radix tree it is, the lower its level: that of a bit of
// the codes, or, where the codes are equal, of the places. Equal codes differ least.
const uint HPLOC_CODE_LEVEL = 32;  // of the lowest bit of a code; 32 more for its high word
const uint HPLOC_LEVELS = 96;
const uint HPLOC_END_LEVEL = 255;  // of what lies before the first and behind the last place

// What the child that comes first leaves at its parent's split: its far end and its clusters.
const uint HPLOC_ARRIVAL_SHIFT = 5;

struct HplocBuildArgs {
  READS(AabbBuffer) boxes;   // of the triangles
  READS(UintBuffer) keys;    // Morton codes in ascending order, key_words each, low word first
  READS(UintBuffer) values;  // triangle indices in the same order, active ones first
  NodeBuffer nodes;          // 2 * active_count - 1
  CoherentNodeBuffer
      clusters;  // active_count: those left of a node whose parent lies in no tile, from its first place on
  CoherentUintBuffer cluster_names;  // active_count: their names
  CoherentUintBuffer arrivals;       // active_count: one a split; zero before and after
  BuildStateBuffer state;
  uint key_words;
  uint radius;         // for the twin: in the kernel the constant RADIUS
  uint cluster_limit;  // HPLOC_CLUSTERS or 1
  uint padding;
};

struct HplocBuildConstants {
  uint cluster_limit;
  uint radius;
};

INTERFACE_END
#endif
