// Morton codes of the centres of boxes, on a cubic grid over the scene's box.
#include "lib/normalised.glsl"

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

// Low word first; the upper one is 0 for codes of 30 bits, but all ones for an inactive primitive.
uvec2 morton_key(Aabb box, Grid grid) {
  if (is_empty(box)) return uvec2(MORTON_INACTIVE);
  uvec3 cell = grid_cell(box, grid);
  return uvec2(interleave(cell & 1023u), interleave(cell >> 10));
}
