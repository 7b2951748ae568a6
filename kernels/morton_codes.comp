// In:  primitive boxes and the scene's box. Out: sort keys (Morton codes of the box centres) and values (indices).
// The grid is cubic and its cell a power of two, so that a code is decided by exact multiplications alone.
// Morton 1966; 30 and 60 bits as in Lauterbach et al. 2009 and Meister and Bittner 2018.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/morton.h"
#include "lib/device_count.glsl"
#include "lib/node_words.glsl"
#include "lib/normalised.glsl"
#include "lib/subgroup_run.glsl"

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

struct Grid {
  Normalisation normalisation;
  vec3 origin;
  float scale;  // cells a normalised unit; 0 where all boxes are at one point
};

Grid scene_grid(BuildState state, uint bits) {
  Normalisation normalisation = scene_normalisation(state);
  vec3 origin = normalised(scene_box_min(state), normalisation);
  precise vec3 extent = normalised(scene_box_max(state), normalisation) - origin;
  float largest = max(max(extent.x, extent.y), extent.z);
  float scale = largest == 0.0 ? 0.0 : power_of_two(int(bits) + 126 - biased_exponent(largest));
  return Grid(normalisation, origin, scale);
}

uvec3 grid_cell(Aabb box, Grid grid) {
  precise vec3 centre =
      (normalised(box.box_min, grid.normalisation) + normalised(box.box_max, grid.normalisation)) * 0.5;
  precise vec3 cell = (centre - grid.origin) * grid.scale;
  return uvec3(cell);
}

bool is_empty(Aabb box) { return box.box_min.x > box.box_max.x; }

void main() {
  uint count = counted(args.count_at, args.triangle_count);
  if (gl_WorkGroupID.x * MORTON_TILE >= count) return;
  Grid grid = scene_grid(args.state.at[0], 10u * args.key_words);
  Run run = subgroup_run(gl_WorkGroupID.x * MORTON_TILE, MORTON_PER_INVOCATION, count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    Aabb box = load_box(args.boxes, i);
    uvec2 key = uvec2(MORTON_INACTIVE);
    if (!is_empty(box)) {
      uvec3 cell = grid_cell(box, grid);
      key = uvec2(interleave(cell & 1023u), interleave(cell >> 10));
    }
    args.keys.at[i * args.key_words] = key.x;
    if (args.key_words == 2u) args.keys.at[i * 2u + 1u] = key.y;
    args.values.at[i] = i;
  }
}
