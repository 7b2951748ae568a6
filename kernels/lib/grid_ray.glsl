// A ray as it meets the children of wide nodes, in the nodes' own grids: the distance of plane q is q * scale + start,
// with one scale and one start a node and axis. Distances are t in units that bring the scene below GRID_RANGE, and not
// negative where they matter, so they compare as integers; where t may be negative they have an offset. The bounds are
// in docs/numerics.md, "Grids".
#ifndef COPPICE_LIB_GRID_RAY
#define COPPICE_LIB_GRID_RAY
#include "trace_ray.glsl"

struct GridRay {
  vec3 origin;
  vec3 inverse;     // finite; 0 for a ray that meets every box
  vec3 room;        // for rounding, in a node that reaches 1 far from the origin: near distances less it, far ones more
  vec3 fixed_room;  // beside that, in every node
  uint backward;    // those of the bytes x, y, z along which the ray goes backward
  int first;        // distance where the ray begins, as bits
  float unit;       // distances of a t of 1, a power of two
  float offset;     // 0, or three ranges
};

const float GRID_RANGE = 8589934592.0;  // 2^33, more than any distance within the scene
const float GRID_SHARE = 0.99609375;    // of the range: no limit has thirteen set bits
const float GRID_LEAST = 2.0;           // distance; 32 binades, which 28 bits tell apart, lie between it and the range

const float GRID_ROOM = 1.9073486328125e-6;                // 2^-19
const float GRID_FIXED_ROOM = 1.1920928955078125e-7;       // 2^-23
const float GRID_OFFSET_ROOM = 3.814697265625e-6;          // 2^-18
const float GRID_FLATTEST = 1.52587890625e-5;              // 2^-16
const float GRID_FARTHEST = 1.152921504606846976e18;       // 2^60: products of farther coordinates may overflow
const float GRID_MEETS_ALL = 8.50705917302346159e37;       // 2^126: beyond every limit
const float GRID_MOST_INVERSE = 1.8446744073709551616e19;  // 2^64, of components that count as 0

float finite_inverse(float x) {
  return isinf(x) ? (floatBitsToUint(x) >> 31 != 0u ? -GRID_MOST_INVERSE : GRID_MOST_INVERSE) : x;
}

// The distance of t, as bits, within the range.
int grid_distance(GridRay grid, float t) {
  precise float distance = clamp(t * grid.unit, -GRID_RANGE, GRID_RANGE * GRID_SHARE) + grid.offset;
  return floatBitsToInt(max(distance, GRID_LEAST));
}

void prepare_grid_ray(TraceRay ray, Aabb scene, out GridRay grid) {
  vec3 reach = reach_of(ray.origin, scene);
  precise float far_end = max(cyclic(reach, ray.axis).z * 1.25 * abs(ray.shear.z), largest(reach) * GRID_FLATTEST);
  // 2^33 by the power of two above; 2^63 at most, which no reciprocal carries out of the range of float.
  uint exponent = clamp((floatBitsToUint(far_end) >> 23) + 1u, 97u, 252u);
  grid.unit = uintBitsToFloat((287u - exponent) << 23);
  grid.offset = ray.t_min < 0.0 ? 3.0 * GRID_RANGE : 0.0;
  grid.origin = ray.origin;
  vec3 inverse = vec3(finite_inverse(ray.inverse.x), finite_inverse(ray.inverse.y), finite_inverse(ray.inverse.z));
  precise vec3 scaled = inverse * grid.unit;
  grid.inverse = scaled;
  grid.room = abs(scaled) * GRID_ROOM;
  float least = grid.offset * GRID_OFFSET_ROOM + 2.0 * GRID_LEAST;
  precise vec3 fixed_room = abs(ray.origin) * GRID_FIXED_ROOM * abs(scaled) + least;
  // Past the share of a limit, so that nothing is met where the ray begins behind the scene.
  precise float first = clamp(ray.t_min * grid.unit, -GRID_RANGE, GRID_RANGE) + grid.offset;
  grid.first = floatBitsToInt(max(first, GRID_LEAST));
  if (!(largest(reach) < GRID_FARTHEST)) {
    grid.inverse = vec3(0.0);
    grid.first = floatBitsToInt(GRID_LEAST);
    grid.room = vec3(0.0);
    fixed_room = vec3(GRID_MEETS_ALL);
  }
  grid.fixed_room = fixed_room;
  grid.backward = (grid.inverse.x < 0.0 ? 0xffu : 0u) | (grid.inverse.y < 0.0 ? 0xff00u : 0u) |
                  (grid.inverse.z < 0.0 ? 0xff0000u : 0u);
}

#endif
