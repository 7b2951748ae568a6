// One tile of the prefix scan: each invocation takes a run of consecutive quads of words. Of the last one the list may
// have only some words, which are taken one by one.

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

// A quad as two words of 64 bits: CPU devices gather and scatter word by word, and take as long for a short one.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer QuadHalvesBuffer { u64vec2 at[]; };

const uint SCAN_TILE_WORDS = 4u * SCAN_TILE;

uint word_count;  // of the list; set before the first tile

shared uint run_sums[SCAN_GROUP];

uvec4 load_quad(uint i) {
  u64vec2 halves = QuadHalvesBuffer(args.source).at[i];
  return uvec4(unpackUint2x32(halves.x), unpackUint2x32(halves.y));
}

// Quads from x to y - 1.
uvec2 run_of(uint tile) {
  uint first = tile * SCAN_TILE + gl_LocalInvocationIndex * SCAN_RUN;
  return uvec2(first, min(first + SCAN_RUN, word_count / 4u));
}

// The words from x to y - 1 follow a run, if it is the one with which the list ends.
uvec2 rest_of(uvec2 run) {
  return uvec2(4u * run.y, run.y - run.x < SCAN_RUN ? word_count : 0u);
}

// The sum of the first `runs` runs; after sum_runs.
uint sum_of_runs(uint runs) {
  uint sum = 0u;
  [[dont_unroll]] for (uint run = 0u; run < runs; ++run) sum += run_sums[run];
  return sum;
}

// The whole workgroup; ends with a barrier.
void sum_runs(uint tile) {
  uvec4 sums = uvec4(0u);
  uvec2 run = run_of(tile);
  [[dont_unroll]] for (uint i = run.x; i < run.y; ++i) sums += load_quad(i);
  uvec2 rest = rest_of(run);
  [[dont_unroll]] for (uint i = rest.x; i < rest.y; ++i) sums.x += UintBuffer(args.source).at[i];
  run_sums[gl_LocalInvocationIndex] = sums.x + sums.y + sums.z + sums.w;
  barrier();
}
