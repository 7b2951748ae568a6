// In:  rays, their hits. Out: one ray from each hit, on the side that the ray came from, its direction distributed by
// the cosine to the normal (a point of the unit disk, lifted to the hemisphere); no hit yet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/exact_vector.glsl"
#include "lib/offset_origin.glsl"
#include "lib/random.glsl"
#include "lib/ray_words.glsl"

layout(local_size_x = BOUNCE_RAYS_GROUP) in;
layout(push_constant, scalar) uniform Push { BounceRaysArgs args; };

const uint DISK_TRIES = 8u;  // all miss the disk once in 200,000 times

vec2 disk_point(inout uint state) {
  vec2 result = vec2(0.0);
  bool found = false;
  [[dont_unroll]] for (uint k = 0u; k < DISK_TRIES && !found; ++k) {
    float x = next_signed(state);
    vec2 point = vec2(x, next_signed(state));
    precise float distance = point.x * point.x + point.y * point.y;
    found = distance < 1.0;
    if (found) result = point;
  }
  return result;
}

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
vec3 around(vec3 normal, vec2 disk) {
  float side = normal.z < 0.0 ? -1.0 : 1.0;
  precise float a = -1.0 / (side + normal.z);
  precise float b = normal.x * normal.y * a;
  precise vec3 tangent = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  precise vec3 bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
  precise float height = sqrt(max(1.0 - (disk.x * disk.x + disk.y * disk.y), 0.0));
  precise vec3 direction = tangent * disk.x + bitangent * disk.y + normal * height;
  return direction;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  float far = uintBitsToFloat(0x7f800000u);
  Hit hit = load_hit(args.hits, i);
  Ray ray = Ray(vec3(0.0), 0.0, vec3(0.0), far);
  if (hit.triangle != NO_TRIANGLE) {
    Triangle triangle = args.triangles.at[hit.triangle];
    vec3 normal = normal_of(triangle);
    if (exact_dot(normal, unit(args.rays.at[i].direction)) > 0.0) normal = -normal;
    uint state = i ^ (args.seed * 0x9e3779b9u);
    next_random(state);
    ray = Ray(offset_origin(triangle, hit.u, hit.v, normal), 0.0, around(normal, disk_point(state)), far);
  }
  store_ray(args.bounced, i, ray);
  store_hit(args.bounced_hits, i, Hit(far, NO_TRIANGLE, 0.0, 0.0));
}
