// A ray as it meets the children of wide nodes, in the nodes' own grids: the distance of plane q is q * scale + start,
// with one scale and one start a node and axis. Distances are t plus an offset that makes them positive, and those
// within the scene lie between two neighbouring powers of two: they compare as integers, and thirteen bits of the
// mantissa say roughly where they are. The bounds are in docs/numerics.md, "Grids".

struct GridRay {
  vec3 origin;
  vec3 inverse;   // finite; 0 for a ray that meets every box
  vec3 near_pad;  // to subtract from near distances
  vec3 far_pad;   // to add to far ones
  uint backward;  // those of the bytes x, y, z along which the ray goes backward
  int first;      // distance where the ray begins, as bits
  float range;    // a power of two, more than any t within the scene
  float offset;
};

const float GRID_ROOM = 3.814697265625e-6;                 // 2^-18
const float GRID_FARTHEST = 1.152921504606846976e18;       // 2^60: products of farther coordinates may overflow
const float GRID_MOST_INVERSE = 1.8446744073709551616e19;  // 2^64, of components that count as 0
const float GRID_SHARE = 0.9990234375;                     // of the range: its thirteen bits are not all set

float finite_inverse(float x) {
  return isinf(x) ? (floatBitsToUint(x) >> 31 != 0u ? -GRID_MOST_INVERSE : GRID_MOST_INVERSE) : x;
}

void prepare_grid_ray(TraceRay ray, Aabb scene, out GridRay grid) {
  vec3 reach = reach_of(ray.origin, scene);
  float along = cyclic(reach, ray.axis).z;
  precise float far_end = along * 1.25 * abs(ray.shear.z);
  float range = uintBitsToFloat(min((floatBitsToUint(far_end) >> 23) + 1u, 252u) << 23);
  float offset = ray.t_min < 0.0 ? 3.0 * range : range;
  precise float first = clamp(ray.t_min, -range, 2.0 * range) + offset;
  vec3 inverse = vec3(finite_inverse(ray.inverse.x), finite_inverse(ray.inverse.y), finite_inverse(ray.inverse.z));
  precise vec3 room = (reach + along + max(abs(scene.box_min), abs(scene.box_max))) * GRID_ROOM;
  precise vec3 pad = room * abs(inverse);
  if (!(largest(reach) < GRID_FARTHEST)) {
    inverse = vec3(0.0);
    first = 0.0;
    pad = vec3(2.0 * offset);
  }
  precise vec3 near_pad = pad - offset;
  precise vec3 far_pad = pad + offset;
  uint backward =
      (inverse.x < 0.0 ? 0xffu : 0u) | (inverse.y < 0.0 ? 0xff00u : 0u) | (inverse.z < 0.0 ? 0xff0000u : 0u);
  grid = GridRay(ray.origin, inverse, near_pad, far_pad, backward, floatBitsToInt(first), range, offset);
}

// The distance of a hit, as bits.
int grid_distance(GridRay grid, float t) {
  precise float distance = min(t, grid.range * GRID_SHARE) + grid.offset;
  return floatBitsToInt(distance);
}
