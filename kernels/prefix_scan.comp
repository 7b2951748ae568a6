// In:  words. Out: for each the sum of all words before it, modulo 2^32.
// Merrill and Garland 2016, "Single-pass Parallel Prefix Scan with Decoupled Look-back". Without lookback the prefixes
// of the tiles come from scan_tile_sums and a scan of its sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/scan.h"

layout(local_size_x = SCAN_GROUP) in;
layout(push_constant, scalar) uniform Push { PrefixScanArgs args; };

#include "lib/count_error.glsl"
#include "lib/scan_tile.glsl"
#define LOOKBACK_GROUP SCAN_GROUP
#define LOOKBACK_SUMS SCAN_SUMS
void sum_tile(uint tile);
#include "lib/lookback.glsl"

shared uint ticket;

void sum_tile(uint tile) {
  sum_runs(tile);
  uint half_index = gl_LocalInvocationIndex;
  if (half_index < SCAN_SUMS)
    tile_sums[half_index] =
        bitfieldExtract(sum_of_runs(SCAN_GROUP), int(half_index * SCAN_HALF_BITS), int(SCAN_HALF_BITS));
  barrier();
}

// The sum of all words before this tile; false if it cannot be known.
bool find_tile_prefix(uint tile, out uint prefix) {
  prefix = 0u;
  if (args.lookback == 0u) {
    prefix = args.tile_status.at[tile];
    return true;
  }
  if (lookback(args.tile_status, tile) > LOOKBACK_MAX_FALLBACKS) return false;
  prefix = lookback_prefix[0] + (lookback_prefix[1] << SCAN_HALF_BITS);
  return true;
}

void scan_run(uint tile, uint sum) {
  QuadHalvesBuffer target = QuadHalvesBuffer(args.target);
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint i = run.x; i < run.y; ++i) {
    uvec4 words = load_quad(i);
    uint second = sum + words.x, third = second + words.y, fourth = third + words.z;
    target.at[i] = u64vec2(packUint2x32(uvec2(sum, second)), packUint2x32(uvec2(third, fourth)));
    sum = fourth + words.w;
  }
  uvec2 rest = rest_of(run);
  [[dont_unroll]] for (uint i = rest.x; i < rest.y; ++i) {
    uint word = UintBuffer(args.source).at[i];
    UintBuffer(args.target).at[i] = sum;
    sum += word;
  }
}

void main() {
  uint tile = gl_WorkGroupID.x;
  if (args.lookback != 0u) {
    // Partners: the workgroups of this scan. The order of tickets is an order in which tiles have started.
    if (gl_LocalInvocationIndex == 0u) ticket = atomicAdd(args.ticket.at[0], 1u);
    barrier();
    tile = started_tile(ticket, gl_NumWorkGroups.x);
  }
  word_count = counted(args.count_at, args.word_count);
  if (tile == 0u && gl_LocalInvocationIndex == 0u) note_count(args.state, args.count_at, args.word_count);
  if (tile * SCAN_TILE_WORDS >= word_count) return;
  sum_tile(tile);
  uint before = sum_of_runs(gl_LocalInvocationIndex);  // now, as a fallback overwrites the runs' sums
  uint prefix;
  if (!find_tile_prefix(tile, prefix)) {
    if (gl_LocalInvocationIndex == 0u) atomicOr(args.state.at[0].error_word, ERROR_SCAN_LOOKBACK);
    return;
  }
  scan_run(tile, prefix + before);
}
