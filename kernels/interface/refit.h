// Refit: the boxes of a tree whose triangles have moved, its topology kept. Nodes of the same height do not
// depend on each other, so an order of the inner nodes by height, made once behind a build, gives as many
// passes as the tree is high; the boxes come bottom-up as in Karras, "Maximizing Parallelism in the
// Construction of BVHs, Octrees, and k-d Trees", 2012, without his atomic counters.
#ifndef COPPICE_INTERFACE_REFIT_H
#define COPPICE_INTERFACE_REFIT_H
#include "types.h"
INTERFACE_BEGIN

const uint REFIT_MAX_HEIGHT = 256;  // of a tree

// The box of a primitive that is inactive at a refit, and of a node above none but such: box_min is this on
// all axes, box_max its negative. It adds nothing to a union, and no ray meets it: all distances to it are
// finite on the ray's longest axis, and the wrong way round. Infinities would not do, as the pad of the
// robust box test grows with the box.
const float NOTHING_BOX = 3.402823466e38;

const uint REFIT_KEYS_GROUP = 64;
const uint REFIT_KEYS_PER_INVOCATION = 16;
const uint REFIT_KEYS_TILE = REFIT_KEYS_GROUP * REFIT_KEYS_PER_INVOCATION;  // nodes
const uint REFIT_GROUP = 64;
const uint REFIT_PER_INVOCATION = 4;
const uint REFIT_TILE = REFIT_GROUP * REFIT_PER_INVOCATION;  // inner nodes
const uint REFIT_REST_GROUP = 256;
const uint REFIT_ABSENT_GROUP = 64;
const uint REFIT_ABSENT_TILE = REFIT_ABSENT_GROUP * 32;  // triangles, 32 an invocation

// Levels that have dispatches of their own; those above, which have few nodes in most trees, one workgroup
// takes in turn (refit_rest).
const uint REFIT_DISPATCHED_LEVELS = 24;

// The order of a refit goes by keys of the height - 1, times four, and the kind of the children.
const uint REFIT_KEY_BITS = 10;
const uint REFIT_TWO_LEAVES = 0;  // those of height 1 and no others
const uint REFIT_LEFT_LEAF = 1;   // the other child is an inner node
const uint REFIT_RIGHT_LEAF = 2;
const uint REFIT_NO_LEAF = 3;

// The inner nodes of one height: `count` of the order, from `first` on. That of height h is level h - 1. In
// all but level 0 come first those whose left child is a leaf, up to the place `left_end`, counted from
// `first`, then, up to `right_end`, those whose right one is; the others have none.
struct RefitLevel {
  uint first, count;
  uint left_end, right_end;
  uvec3 groups;  // of a dispatch over them
  uint padding;
};

// What a refit found; zero before.
struct RefitState {
  uint appeared_count;  // active triangles that have no leaf, as they were inactive when the tree was built
  uint padding0;
  // Half areas in normalised coordinates of the root's box, times 2^-32: of all nodes, and of the root.
  float area_sum, root_area;
};

INTERFACE_BUFFER(RefitLevelBuffer, RefitLevel, 16)
INTERFACE_BUFFER(RefitStateBuffer, RefitState, 16)

// By the pair of its children: the first pair, k = 0, stands at nodes 1 and 2.
struct RefitKeysArgs {
  READS(NodeBuffer) nodes;  // 2 * active_count - 1
  UintBuffer keys;          // out, active_count - 1: of each pair the key of its parent
  UintBuffer parents;       // out, active_count - 1: of each pair its parent
  UintBuffer pair_count;    // out, one word: active_count - 1; 0 for a tree that is too high
  BuildStateBuffer state;   // a tree higher than REFIT_MAX_HEIGHT sets ERROR_REFIT_TOO_DEEP
  uint node_limit;          // no tree has more nodes
  uint padding;
};

struct RefitLevelsArgs {
  READS(UintBuffer) keys;        // pair_count, in ascending order
  READS(UintBuffer) pair_count;  // one word
  RefitLevelBuffer levels;       // out, REFIT_MAX_HEIGHT + 1: the last one is empty
};

struct RefitAbsentArgs {
  READS(TriangleBuffer) triangles;  // triangle_count
  UintBuffer absent;  // out, a bit for each triangle that is inactive; not written where none is
  READS(BuildStateBuffer) state;
  uint triangle_count;  // planned; of them as many count as were asked for
  uint padding;
};

struct RefitAppearedArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) absent;
  READS(BuildStateBuffer) state;
  RefitStateBuffer refit;  // appeared_count
  uint triangle_count;
  uint padding;
};

struct RefitBoxesArgs {
  NodeBuffer nodes;
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) order;  // inner nodes by ascending key
  READS(RefitLevelBuffer) levels;
  uint level;
  uint padding;
};

// The same for all levels from `level` on; and the box of a tree that is one leaf.
struct RefitRestArgs {
  CoherentNodeBuffer nodes;
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) order;
  READS(RefitLevelBuffer) levels;
  READS(BuildStateBuffer) state;
  uint level;
  uint padding;
};

const uint TREE_AREAS_GROUP = 64;
const uint TREE_AREAS_PER_INVOCATION = 16;
const uint TREE_AREAS_TILE = TREE_AREAS_GROUP * TREE_AREAS_PER_INVOCATION;  // nodes
const float TREE_AREAS_SCALE = 2.3283064365386963e-10;                      // 2^-32

struct TreeAreasArgs {
  READS(NodeBuffer) nodes;
  FloatBuffer tile_areas;  // out: one a tile of nodes
  READS(BuildStateBuffer) state;
  uint node_limit;
  uint padding;
};

struct TreeAreaSumArgs {
  READS(NodeBuffer) nodes;
  READS(FloatBuffer) tile_areas;
  READS(BuildStateBuffer) state;
  RefitStateBuffer refit;  // area_sum, root_area
};

INTERFACE_END
#endif
