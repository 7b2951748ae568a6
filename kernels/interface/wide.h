// Wide tree: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", 2017: eight children a node, their boxes in 8 bits a plane on a grid of the node's own.
#ifndef COPPICE_INTERFACE_WIDE_H
#define COPPICE_INTERFACE_WIDE_H
#include "types.h"
INTERFACE_BEGIN

const uint WIDE_CHILDREN = 8;
const uint WIDE_PLANE_WORDS = 12;
const uint WIDE_LEAF = 0x80000000u;   // in a child word: the rest is a triangle index; else it is a wide node
const uint WIDE_EMPTY = 0xffffffffu;  // no child

// Child c has six bytes of `planes` from byte 6 c on: min x, y, z, max x, y, z. A byte q of an axis means the
// plane origin + q * step, rounded as float arithmetic rounds it; the step is the power of two whose biased
// exponent is the axis' byte of `exponents` (x lowest). The box so decoded contains the child's box. An empty
// child is min 255, max 0.
struct WideNode {
  vec3 origin;
  uint exponents;
  uint planes[WIDE_PLANE_WORDS];
  uint child[WIDE_CHILDREN];
};

const uint WIDE_NODE_WORDS = 24;

INTERFACE_BUFFER(WideNodeBuffer, WideNode, 16)

// The conversion goes level by level, so a wide node first has an index in breadth-first order, and its place
// in depth-first order at the end.

const uint WIDE_GROUP = 64;
const uint WIDE_TILE = 32;   // wide nodes of a level whose children one workgroup finds
const uint WIDE_BLOCK = 64;  // tiles that are summed together

// Levels that have dispatches of their own. Deeper ones, of which few trees have any, one subgroup takes in
// turn (wide_collapse_rest, wide_sizes_rest).
const uint WIDE_DISPATCHED_LEVELS = 32;
const uint WIDE_MAX_HEIGHT = 256;     // of the binary tree; so levels of the wide one, at most
const uint WIDE_LEAST_EXPONENT = 27;  // biased, of a step: 2^-100, so that no plane is denormal
const float WIDE_NODE_STEPS = 512.0;  // no node has a longer extent, in its longest steps

// A child of height 1 or 2 counts with its area times these, so that few wide nodes have only two or three
// children.
const float WIDE_HEIGHT_1_WEIGHT = 16.0;
const float WIDE_HEIGHT_2_WEIGHT = 4.0;

// A child of a smaller part of its node's area is too small for the node's grid, which would make its own
// children as large as a step. It is opened only while there are fewer children than WIDE_LEAST_CHILDREN, or
// if it is no higher than WIDE_LOW_HEIGHT; else it remains a wide node with a grid of its own.
const float WIDE_SMALL_PARTS = 1024.0;  // to one
const uint WIDE_LEAST_CHILDREN = 3;
const uint WIDE_LOW_HEIGHT = 2;

// What is known of a wide node before it has its place; indices are breadth-first.
struct WideEntry {
  uint root;         // the internal binary node it stands for, or the only leaf
  uint parent;       // itself for the first one
  uint first_child;  // of its children that are wide nodes; they follow each other
  uint child_count;  // of these
};

// One level of the wide tree, written by the last tile of the level above. Zero behind the last level.
struct WideLevel {
  uint first;       // entry
  uint count;       // of entries
  uint first_tile;  // its place in tile_sums
  uint first_block;
  uvec3 groups;  // of dispatches over its tiles
  uint padding;
};

struct WideCounts {
  uint node_count;  // 0: no tree
  uint level_count;
  uvec3 groups;  // of a dispatch over all wide nodes
  uint padding0, padding1, padding2;
};

INTERFACE_BUFFER(WideEntryBuffer, WideEntry, 16)
INTERFACE_COHERENT_BUFFER(CoherentWideEntryBuffer, WideEntry, 16)
INTERFACE_BUFFER(WideLevelBuffer, WideLevel, 16)
INTERFACE_COHERENT_BUFFER(CoherentWideLevelBuffer, WideLevel, 16)
INTERFACE_BUFFER(WideCountsBuffer, WideCounts, 16)

struct WideCollapseArgs {
  READS(NodeBuffer) nodes;  // the binary tree
  WideEntryBuffer entries;  // one a wide node, like children
  UintBuffer children;      // WIDE_CHILDREN each: binary nodes, leaves with WIDE_LEAF; or WIDE_EMPTY
  UintBuffer tile_sums;     // children that are wide nodes, by tile; zero before
  UintBuffer block_sums;    // the same by WIDE_BLOCK tiles
  WideLevelBuffer levels;   // one more than there may be; zero before
  WideCountsBuffer counts;  // zero before
  BuildStateBuffer state;
  uint level;  // whose children are found; unused by wide_root
  uint padding;
};

// The same for all levels from `level` on: each reads what the ones before have written.
struct WideCollapseRestArgs {
  READS(NodeBuffer) nodes;
  CoherentWideEntryBuffer entries;
  CoherentUintBuffer children;
  CoherentUintBuffer tile_sums;
  CoherentUintBuffer block_sums;
  CoherentWideLevelBuffer levels;
  WideCountsBuffer counts;
  BuildStateBuffer state;
  uint level;
  uint level_limit;  // no level has this index
};

struct WideSizesArgs {
  READS(WideEntryBuffer) entries;
  UintBuffer sizes;    // out: wide nodes of the subtree
  UintBuffer offsets;  // out: of the children, their places in depth-first order counted from the parent's
  READS(WideLevelBuffer) levels;
  uint level;
  uint padding;
};

// The same for all levels from the last one to `level`.
struct WideSizesRestArgs {
  READS(WideEntryBuffer) entries;
  CoherentUintBuffer sizes;
  UintBuffer offsets;
  READS(WideLevelBuffer) levels;
  uint level;
  uint level_limit;
};

struct WideQuantiseArgs {
  READS(NodeBuffer) nodes;
  READS(WideEntryBuffer) entries;
  READS(UintBuffer) children;
  READS(UintBuffer) offsets;
  READS(WideCountsBuffer) counts;
  WideNodeBuffer wide_nodes;  // node_count, in depth-first order
};

INTERFACE_END
#endif
