#ifndef COPPICE_INTERFACE_MORTON_H
#define COPPICE_INTERFACE_MORTON_H
#include "types.h"
INTERFACE_BEGIN

const uint MORTON_GROUP = 64;
const uint MORTON_PER_INVOCATION = 16;
const uint MORTON_TILE = MORTON_GROUP * MORTON_PER_INVOCATION;
const uint MORTON_INACTIVE = 0xffffffffu;  // every key word of an inactive triangle: sorts behind all codes

struct MortonCodesArgs {
  READS(AabbBuffer) boxes;        // triangle_count
  READS(BuildStateBuffer) state;  // scene box
  UintBuffer keys;                // triangle_count * key_words, low word first
  UintBuffer values;              // triangle_count: triangle indices
  READS(UintBuffer) count_at;     // null, or how many of them count
  uint triangle_count;
  uint key_words;  // 1: 30-bit codes, 2: 60-bit codes
};

INTERFACE_END
#endif
