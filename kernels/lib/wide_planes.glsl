// The grid of a wide node, and the planes of a child's box on it: Ylitie, Karras and Laine 2017, section 3.1.
// Each plane is found by comparing a decoded plane with the box, so that the decoded box contains the child's, whatever
// the rounding: docs/numerics.md.

struct Grid {
  vec3 origin, cell;
  vec3 half_origin, scale;  // scale: 2 / cell
  vec3 planes_end;          // from this plane on they are infinite, or there are none
};

vec3 plane(Grid grid, vec3 q) {
  precise vec3 position = grid.origin + q * grid.cell;
  return position;
}

vec3 cells_of(uvec3 exponents) { return uintBitsToFloat(exponents << 23); }

// The smallest powers of two with which the grid reaches the other end of the box. It is one of three, see
// docs/numerics.md.
uvec3 cell_exponents(Node node) {
  precise vec3 extent = node.box_max - node.box_min;
  uvec3 exponents = max(floatBitsToUint(extent) >> 23, uvec3(WIDE_LEAST_EXPONENT + 8u)) - 8u;
  [[unroll]] for (uint larger = 0u; larger < 2u; ++larger) {
    precise vec3 end = node.box_min + 255.0 * cells_of(exponents);
    exponents += mix(uvec3(0u), uvec3(1u), lessThan(end, node.box_max));
  }
  return exponents;
}

Grid grid_of(vec3 origin, uvec3 exponents) {
  uvec3 doublings = 255u - max(exponents, uvec3(247u));  // of a cell up to infinity
  vec3 planes_end = uintBitsToFloat((doublings + 127u) << 23);
  return Grid(origin, cells_of(exponents), origin * 0.5, uintBitsToFloat((255u - exponents) << 23), planes_end);
}

// A quarter of the distance to the next position of larger magnitude or, where `inwards` has all bits, of smaller.
vec3 quarter_gap(ivec3 bits, ivec3 inwards) {
  ivec3 exponent = ((bits & 0x7fffffff) + inwards) >> 23;
  return intBitsToFloat((max(exponent, ivec3(25)) - 25) << 23);
}

const float PLANE_ROOM = 1.0 / 1024.0;  // more than the estimate is off

// The last planes that are not above the position: the estimate or the next.
vec3 planes_below(Grid grid, vec3 position) {
  ivec3 bits = floatBitsToInt(position);
  precise vec3 distance = position * 0.5 - grid.half_origin + quarter_gap(bits, bits >> 31);
  vec3 q = clamp(floor(distance * grid.scale - PLANE_ROOM), vec3(0.0), min(grid.planes_end, 256.0) - 2.0);
  return q + mix(vec3(1.0), vec3(0.0), greaterThan(plane(grid, q + 1.0), position));
}

// The first planes that are not below the position: the estimate or the one before.
vec3 planes_above(Grid grid, vec3 position) {
  ivec3 bits = floatBitsToInt(position);
  precise vec3 distance = position * 0.5 - grid.half_origin - quarter_gap(bits, ~(bits >> 31));
  vec3 q = clamp(ceil(distance * grid.scale + PLANE_ROOM), vec3(1.0), min(grid.planes_end, 255.0));
  return q - mix(vec3(1.0), vec3(0.0), lessThan(plane(grid, q - 1.0), position));
}

// Three bytes in a word, x lowest; exact, as it has 24 bits.
uint bytes_of(vec3 q) { return uint(int(q.x + q.y * 256.0 + q.z * 65536.0)); }

// The planes of a child as two words: min x, y, z, max x and max y, z.
uvec2 planes_of(Grid grid, vec3 box_min, vec3 box_max) {
  uint low = bytes_of(planes_below(grid, box_min)), high = bytes_of(planes_above(grid, box_max));
  return uvec2(low | high << 24, high >> 8);
}

const uvec2 EMPTY_PLANES = uvec2(0xffffffu, 0u);
