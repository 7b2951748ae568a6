// Many small trees in one dispatch.
#ifndef COPPICE_INTERFACE_BATCH_H
#define COPPICE_INTERFACE_BATCH_H
#include "ploc.h"
INTERFACE_BEGIN

// A tree's sort and its rounds go on in shared memory: 32 bytes a cluster, 8 a code and 4 a partner. Of
// powers of two, which the sort pads to, 512 is the greatest that 32 KiB hold: it takes 22 KiB.
const uint BATCH_MAX_PRIMITIVES = 512;
const uint BATCH_ROUNDS_BOUND = PLOC_EPOCH_ROUNDS * 9 + 2;  // of PLOC, for so many; docs/numerics.md

// The primitives of one tree.
struct BatchRange {
  uint first;
  uint count;
};

// What is known of one tree.
struct BatchTree {
  uint active_count;  // primitives in it; 0: no tree
  uint round_count;
  uint error_word;
  uint padding;
};

INTERFACE_BUFFER(BatchRangeBuffer, BatchRange, 8)
INTERFACE_BUFFER(BatchTreeBuffer, BatchTree, 16)

struct BatchBuildArgs {
  READS(BatchRangeBuffer) ranges;  // range_count
  READS(AabbBuffer) boxes;         // primitive_count
  NodeBuffer nodes;                // 2 * primitive_count; the tree of a range from 2 * first on
  BatchTreeBuffer trees;           // range_count
  BuildStateBuffer state;          // error bits of all trees; primitive_count: the ranges that were asked for
  READS(UintBuffer) count_at;      // null, or how many of the ranges count
  READS(UintBuffer) primitives_at;  // null, or how many of the primitives count
  uint range_count;
  uint primitive_count;
  uint key_words;  // 1: 30-bit codes, 2: 60-bit codes
  uint radius;     // for the twin: in the kernel the constant RADIUS
};

// Specialization constants.
struct BatchBuildConstants {
  uint radius;
};

INTERFACE_END
#endif
