// Ray and triangle, from both sides. Of equally close triangles the smallest index wins, whatever the order of tests.
#ifndef COPPICE_LIB_INTERSECT_TRIANGLE
#define COPPICE_LIB_INTERSECT_TRIANGLE
#include "exact_vector.glsl"
#include "selected.glsl"
#include "trace_ray.glsl"

void keep_closer(TraceRay ray, float t, uint index, float u, float v, inout Hit hit) {
  if (!(t >= ray.t_min && t <= hit.t) || (t == hit.t && index >= hit.triangle)) return;
  hit = Hit(t, index, u, v);
}

// Moller and Trumbore 1997, without a threshold: the inside tests compare with the determinant itself, so they hold at
// every scale, and only a determinant of zero (edge-on or degenerate) misses.
void intersect_fast(TraceRay ray, Triangle triangle, uint index, inout Hit hit) {
  precise vec3 edge_b = triangle.b - triangle.a;
  precise vec3 edge_c = triangle.c - triangle.a;
  vec3 p = exact_cross(ray.direction, edge_c);
  float determinant = exact_dot(edge_b, p);
  float side = determinant < 0.0 ? -1.0 : 1.0;
  precise vec3 from_a = ray.origin - triangle.a;
  float u = exact_dot(from_a, p) * side;
  vec3 q = exact_cross(from_a, edge_b);
  float v = exact_dot(ray.direction, q) * side;
  precise float u_plus_v = u + v;
  if (!(u >= 0.0 && v >= 0.0 && u_plus_v <= determinant * side) || determinant == 0.0) return;
  float t = exact_dot(edge_c, q) / determinant;
  keep_closer(ray, t, index, u / (determinant * side), v / (determinant * side), hit);
}

bool are_mixed(vec3 signs) {
  return lesser(lesser(signs.x, signs.y), signs.z) < 0.0 && greater(greater(signs.x, signs.y), signs.z) > 0.0;
}

const float WATERTIGHT_SLIVER = 0.015625;  // 2^-6, of a triangle of size 1 to 2

// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": corners are sheared so that the ray is the z
// axis, and the signs of the edge functions are exact, so of the triangles around an edge or corner one is hit. Where
// the paper goes to double, error-free transforms of floats do as well on every device. Corners are scaled by a power of
// two first, so that products neither over- nor underflow.
void intersect_watertight(TraceRay ray, Triangle triangle, uint index, inout Hit hit) {
  precise vec3 a = cyclic(triangle.a - ray.origin, ray.axis);
  precise vec3 b = cyclic(triangle.b - ray.origin, ray.axis);
  precise vec3 c = cyclic(triangle.c - ray.origin, ray.axis);
  precise vec2 a_sheared = a.xy - ray.shear.xy * a.z;
  precise vec2 b_sheared = b.xy - ray.shear.xy * b.z;
  precise vec2 c_sheared = c.xy - ray.shear.xy * c.z;
  vec2 sizes = greater(greater(abs(a_sheared), abs(b_sheared)), abs(c_sheared));
  float size = greater(sizes.x, sizes.y);
  if (!(size > 0.0) || isinf(size)) return;
  float scale = uintBitsToFloat(max(254u - (floatBitsToUint(size) >> 23), 1u) << 23);
  precise vec2 p = a_sheared * scale, q = b_sheared * scale, r = c_sheared * scale;
  precise vec3 beside = vec3(r.x * q.y - r.y * q.x, p.x * r.y - p.y * r.x, q.x * p.y - q.y * p.x);  // bc, ca, ab
  if (are_mixed(beside)) return;
  precise float sum = beside.x + beside.y + beside.z;
  // A zero may be a difference that rounding lost, and small ones are mostly rounding.
  if (!(abs(sum) >= WATERTIGHT_SLIVER) || beside.x == 0.0 || beside.y == 0.0 || beside.z == 0.0) {
    beside = vec3(product_difference(r.x, q.y, r.y, q.x), product_difference(p.x, r.y, p.y, r.x),
                  product_difference(q.x, p.y, q.y, p.x));
    sum = beside.x + beside.y + beside.z;
    if (are_mixed(beside) || sum == 0.0) return;
  }
  // Divided first: a product of a small function and a small depth would underflow.
  precise vec3 share = beside / sum;
  precise float depth = share.x * a.z + share.y * b.z + share.z * c.z;
  precise float t = depth * ray.shear.z;
  keep_closer(ray, t, index, share.y, share.z, hit);
}

void intersect_triangle(TraceRay ray, Triangle triangle, uint index, inout Hit hit) {
  if (TRACE_TRIANGLE_TEST == TRIANGLE_WATERTIGHT) intersect_watertight(ray, triangle, index, hit);
  else intersect_fast(ray, triangle, index, hit);
}

#endif
