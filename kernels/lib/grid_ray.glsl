// A ray as it meets the children of wide nodes, in the nodes' own grids: the distance of plane q is q * scale + start,
// with one scale and one start a node and axis. Distances are t, and not negative where they matter, so they compare as
// integers; a ray whose t may be negative counts from before the scene, with an offset. The bounds are in
// docs/numerics.md, "Grids".

struct GridRay {
  vec3 origin;
  vec3 inverse;     // finite; 0 for a ray that meets every box
  vec3 room;        // t by which slabs are widened, for a corner of the node one unit away
  vec3 near_fixed;  // to subtract from near distances besides
  vec3 far_fixed;   // to add to far ones
  uint backward;    // those of the bytes x, y, z along which the ray goes backward
  int first;        // distance where the ray begins, as bits
  int base;         // the least distance, as bits; smaller ones count as it
  float range;      // a power of two, more than any t within the scene
  float offset;     // of distances: 0, or three ranges
};

const float GRID_ROOM = 1.9073486328125e-6;                // 2^-19
const float GRID_FIXED_ROOM = 1.1920928955078125e-7;       // 2^-23
const float GRID_OFFSET_ROOM = 3.814697265625e-6;          // 2^-18
const float GRID_FARTHEST = 1.152921504606846976e18;       // 2^60: products of farther coordinates may overflow
const float GRID_MEETS_ALL = 8.50705917302346159e37;       // 2^126: beyond every limit
const float GRID_MOST_INVERSE = 1.8446744073709551616e19;  // 2^64, of components that count as 0
const float GRID_SHARE = 0.99609375;                       // of the range: no distance has thirteen set bits
const uint GRID_BINADES = 32u;                             // below the range, that distances are told apart in

float finite_inverse(float x) {
  return isinf(x) ? (floatBitsToUint(x) >> 31 != 0u ? -GRID_MOST_INVERSE : GRID_MOST_INVERSE) : x;
}

// A distance as bits: t, brought within the range.
int grid_distance(GridRay grid, float t) {
  precise float distance = clamp(t, -grid.range, grid.range * GRID_SHARE) + grid.offset;
  return max(floatBitsToInt(distance), grid.base);
}

void prepare_grid_ray(TraceRay ray, Aabb scene, out GridRay grid) {
  vec3 reach = reach_of(ray.origin, scene);
  precise float far_end = cyclic(reach, ray.axis).z * 1.25 * abs(ray.shear.z);
  uint exponent = min((floatBitsToUint(far_end) >> 23) + 1u, 252u);
  grid.range = uintBitsToFloat(exponent << 23);
  grid.offset = ray.t_min < 0.0 ? 3.0 * grid.range : 0.0;
  grid.base = int(ray.t_min < 0.0 ? exponent + 1u : max(exponent, GRID_BINADES) - GRID_BINADES) << 23;
  grid.origin = ray.origin;
  grid.inverse = vec3(finite_inverse(ray.inverse.x), finite_inverse(ray.inverse.y), finite_inverse(ray.inverse.z));
  precise vec3 room = abs(grid.inverse) * GRID_ROOM;
  precise vec3 fixed_room = abs(ray.origin) * GRID_FIXED_ROOM * abs(grid.inverse) + grid.offset * GRID_OFFSET_ROOM;
  grid.room = room;
  precise float first = clamp(ray.t_min, -grid.range, grid.range) + grid.offset;
  grid.first = max(floatBitsToInt(first), grid.base);
  if (!(largest(reach) < GRID_FARTHEST)) {
    grid.inverse = vec3(0.0);
    grid.room = vec3(0.0);
    grid.first = grid.base;
    fixed_room = vec3(GRID_MEETS_ALL);
  }
  precise vec3 near_fixed = fixed_room - grid.offset;
  precise vec3 far_fixed = fixed_room + (grid.offset + 2.0 * intBitsToFloat(grid.base));
  grid.near_fixed = near_fixed;
  grid.far_fixed = far_fixed;
  grid.backward = (grid.inverse.x < 0.0 ? 0xffu : 0u) | (grid.inverse.y < 0.0 ? 0xff00u : 0u) |
                  (grid.inverse.z < 0.0 ? 0xff0000u : 0u);
}
