// Decoupled lookback over tiles that carry LOOKBACK_SUMS sums each: Merrill and Garland 2016, "Single-pass Parallel
// Prefix Scan with Decoupled Look-back". Vulkan promises no progress between workgroups, so a tile polls its
// predecessor a bounded number of times and then sums it up itself (Smith, Levien and Owens 2025, "Decoupled Fallback").
//
// The including kernel defines LOOKBACK_GROUP, LOOKBACK_SUMS and `void sum_tile(uint tile)`, by which the whole
// workgroup writes the sums of any tile to `tile_sums`.
//
// A status word is zero, or a flag and a 30-bit sum; it only ever goes from zero to aggregate to inclusive prefix, so
// each word is its own message and needs no fence.

#include "interface/lookback.h"

const uint LOOKBACK_AGGREGATE = 0x40000000u;
const uint LOOKBACK_INCLUSIVE = 0x80000000u;
const uint LOOKBACK_VALUE = 0x3fffffffu;
const uint LOOKBACK_POLLS = 16u;       // unrolled, so that old lavapipe's loop limit counts them as one

layout(constant_id = 0) const uint LOOKBACK_TURNS = 16u;  // of LOOKBACK_POLLS each
layout(constant_id = 1) const uint LOOKBACK_MAX_FALLBACKS = 64u;
// Bits of interface/lookback.h, for tests: tiles that start out of order, report late or not at all. The sums stay the
// same. Zero in every other build, and compiled away.
layout(constant_id = 2) const uint LOOKBACK_STRESS = 0u;

shared uint tile_sums[LOOKBACK_SUMS];
shared uint lookback_own[LOOKBACK_SUMS];
shared uint lookback_prefix[LOOKBACK_SUMS];  // the result: sums over all tiles before this one
shared uint lookback_vote;

bool any_in_workgroup(bool vote) {
  if (gl_LocalInvocationIndex == 0u) lookback_vote = 0u;
  barrier();
  if (vote) atomicOr(lookback_vote, 1u);  // partners: this workgroup
  barrier();
  bool any_vote = lookback_vote != 0u;
  barrier();
  return any_vote;
}

uint poll(CoherentUintBuffer status, uint word_index, uint turns) {
  uint word = status.at[word_index];
  [[dont_unroll]] for (uint turn = 0u; turn < turns && word == 0u; ++turn) {
    [[unroll]] for (uint k = 0u; k < LOOKBACK_POLLS; ++k) {
      if (word == 0u) word = status.at[word_index];
    }
  }
  return word;
}

// The tile that is the `ticket`-th to start, of `tile_count`.
uint started_tile(uint ticket, uint tile_count) {
  if ((LOOKBACK_STRESS & LOOKBACK_REVERSED) == 0u) return ticket;
  uint first = ticket - ticket % LOOKBACK_REVERSED_TILES;
  return first + min(first + LOOKBACK_REVERSED_TILES, tile_count) - 1u - ticket;
}

// One of the tiles 1, 2, ... that store no word, not even those of others.
bool is_silent(uint tile) { return tile - 1u < LOOKBACK_STRESS >> LOOKBACK_SILENT_SHIFT; }

// Whether the tile leaves out, of its v-th sum, the word that `flag` marks.
bool withholds(uint tile, uint v, uint flag) {
  if (is_silent(tile)) return true;
  if ((LOOKBACK_STRESS & LOOKBACK_WITHHELD) == 0u) return false;
  uint hash = (tile * 8u + v % 8u + 1u) * 0x9e3779b9u;
  hash = (hash ^ (hash >> 15)) * 0x85ebca6bu;
  return (hash & flag) != 0u;  // each flag is one of the hash's upper bits
}

// Whole workgroup, with the tile's own sums in tile_sums. Returns the number of tiles it had to sum up itself, which
// overwrites tile_sums; more than LOOKBACK_MAX_FALLBACKS means that it gave up.
uint lookback(CoherentUintBuffer status, uint tile) {
  uint lane = gl_LocalInvocationIndex;
  uint first_flag = tile == 0u ? LOOKBACK_INCLUSIVE : LOOKBACK_AGGREGATE;
  [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
    uint own = tile_sums[v];
    if (!withholds(tile, v, first_flag)) status.at[tile * LOOKBACK_SUMS + v] = first_flag | own;
    lookback_own[v] = own;
    lookback_prefix[v] = 0u;
  }

  uint fallbacks = 0u;
  uint closed = 0u;  // bit k: the lane's k-th sum has met an inclusive prefix
  bool open = true;
  [[dont_unroll]] for (uint p = tile; p > 0u && open; --p) {
    uint base = (p - 1u) * LOOKBACK_SUMS;
    uint turns = LOOKBACK_TURNS;
    bool missing = false;
    uint bit = 1u;
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP, bit <<= 1) {
      if ((closed & bit) == 0u && poll(status, base + v, turns) == 0u) {
        missing = true;
        turns = 0u;
      }
    }
    if (any_in_workgroup(missing)) {
      if (++fallbacks > LOOKBACK_MAX_FALLBACKS) return fallbacks;
      sum_tile(p - 1u);
      [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
        // Partner: the tile's own workgroup, whose words are never replaced.
        if (!is_silent(tile)) atomicCompSwap(status.at[base + v], 0u, LOOKBACK_AGGREGATE | tile_sums[v]);
      }
    }
    open = false;
    bit = 1u;
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP, bit <<= 1) {
      if ((closed & bit) != 0u) continue;
      uint word = status.at[base + v];
      if (is_silent(tile) && word == 0u) word = tile_sums[v];
      lookback_prefix[v] += word & LOOKBACK_VALUE;
      if ((word & LOOKBACK_INCLUSIVE) != 0u) closed |= bit;
      else open = true;
    }
    open = any_in_workgroup(open);
  }

  if (tile != 0u) {
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
      if (withholds(tile, v, LOOKBACK_INCLUSIVE)) continue;
      status.at[tile * LOOKBACK_SUMS + v] = LOOKBACK_INCLUSIVE | (lookback_prefix[v] + lookback_own[v]);
    }
  }
  barrier();
  return fallbacks;
}
