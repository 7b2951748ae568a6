// In:  primitive boxes and the scene's box. Out: sort keys (Morton codes of the box centres) and values (indices).
// The grid is cubic and its cell a power of two, so that a code is decided by exact multiplications alone.
// Morton 1966; 30 and 60 bits as in Lauterbach et al. 2009 and Meister and Bittner 2018.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/morton.h"
#include "lib/normalised.glsl"

layout(local_size_x = MORTON_GROUP) in;
layout(push_constant, scalar) uniform Push { MortonCodesArgs args; };

// Bit i of a ten-bit number moves to bit 3 i.
uint spread(uint x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

uint interleave(uvec3 cell) {
  return (spread(cell.x) << 2) | (spread(cell.y) << 1) | spread(cell.z);
}

uvec3 grid_cell(Aabb box, BuildState state, uint bits) {
  Normalisation normalisation = scene_normalisation(state);
  vec3 origin = normalised(scene_box_min(state), normalisation);
  precise vec3 extent = normalised(scene_box_max(state), normalisation) - origin;
  float largest = max(max(extent.x, extent.y), extent.z);
  if (largest == 0.0) return uvec3(0u);
  precise vec3 centre =
      (normalised(box.box_min, normalisation) + normalised(box.box_max, normalisation)) * 0.5;
  precise vec3 cell = (centre - origin) * power_of_two(int(bits) + 126 - biased_exponent(largest));
  return uvec3(cell);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.triangle_count) return;
  args.values.at[i] = i;
  Aabb box = args.boxes.at[i];
  if (box.box_min.x > box.box_max.x) {
    for (uint word = 0u; word < args.key_words; ++word) args.keys.at[i * args.key_words + word] = MORTON_INACTIVE;
    return;
  }
  uvec3 cell = grid_cell(box, args.state.at[0], 10u * args.key_words);
  args.keys.at[i * args.key_words] = interleave(cell & 1023u);
  if (args.key_words == 2u) args.keys.at[i * 2u + 1u] = interleave(cell >> 10);
}
