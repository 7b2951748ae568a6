// Where a ray leaves a surface: Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", section 3.9.5; Waechter
// and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection". The point is moved off the triangle's
// plane by a bound of its own error and of that of the tests that will look for it again, so no ray meets the triangle
// it starts from, and the distance scales with the scene. The bound is derived in docs/numerics.md.
#include "hit_point.glsl"

const float ORIGIN_ROOM = 9.5367431640625e-7;  // 2^-20

// `normal` is of unit length and points to the side on which the ray leaves.
vec3 offset_origin(Triangle triangle, float u, float v, vec3 normal) {
  vec3 point = hit_point(triangle, u, v);
  precise vec3 edge_b = triangle.b - triangle.a;
  precise vec3 edge_c = triangle.c - triangle.a;
  vec3 extent = max(abs(edge_b), abs(edge_c));
  float size = max(max(extent.x, extent.y), extent.z);
  precise vec3 room = (max(max(abs(triangle.a), abs(triangle.b)), abs(triangle.c)) + size) * ORIGIN_ROOM;
  precise vec3 result = point + normal * exact_dot(abs(normal), room);
  return result;
}
