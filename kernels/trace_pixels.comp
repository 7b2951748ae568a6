// In:  a wide tree and the film of a picture of one sample a pixel. Out: RGBA8 pixels, the same bits as camera_rays,
// trace_wide and shade_pixels make of them, in one go: no ray and no hit is kept. Rays go by packets
// (lib/wide_packet.glsl), whose triangles are still in the cache when their pixels are shaded.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/shade.h"
#include "lib/camera_ray.glsl"
#include "lib/film_pixel.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { TracePixelsArgs args; };
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // as in trace_closest
layout(constant_id = 1) const uint SHADE_DIRECTIONAL_LIGHT = 1u;   // as in shade_pixels

#include "lib/wide_packet.glsl"
#include "lib/plain_pixel.glsl"

bool packet_sees(uint r, uint triangle) { return true; }

uint packet_ray(uint r) { return gl_WorkGroupID.x * TRACE_PACKET + r * LANES + lane(); }

vec3 direction_through(uvec2 pixel, Film film) { return camera_direction(vec2(pixel) + 0.5, film); }

void prepare(uint r, Film film, Aabb scene, inout RayBundle bundle) {
  leave_out(r);
  if (packet_ray(r) >= args.ray_count) return;
  float far = uintBitsToFloat(0x7f800000u);
  vec3 direction = direction_through(film_pixel(args.first_ray + packet_ray(r), film), film);
  if (!prepare_ray(Ray(film.position, 0.0, direction, far), rays[r])) return;
  approach_scene(scene, rays[r]);
  hits[r] = Hit(far, NO_TRIANGLE, 0.0, 0.0);
  add_to_bundle(rays[r], bundle);
}

shared uint seen[TRACE_PACKET];  // triangles; each invocation has its own part, indexed at run time

void shade(Film film, Lighting lighting) {
  [[dont_unroll]] for (uint r = 0u; r < RAYS; ++r) {
    if (packet_ray(r) >= args.ray_count) return;
    uvec2 pixel = film_pixel(args.first_ray + packet_ray(r), film);
    args.image.at[pixel.y * film.width + pixel.x] =
        plain_pixel(seen[r * LANES + lane()], direction_through(pixel, film), lighting);
  }
}

void main() {
  Film film = args.film.at[0];
  uint visited = 0u, ray_count = 0u, hit_count = 0u;
  Node root = Node(vec3(0.0), 0u, vec3(0.0), 0u);
  bool has_tree = args.wide_counts.at[0].node_count != 0u;
  if (has_tree) root = args.nodes.at[0];
  RayBundle bundle = empty_bundle();
  [[unroll]] for (uint r = 0u; r < RAYS; ++r) prepare(r, film, Aabb(root.box_min, root.box_max), bundle);
  if (has_tree) {
    bind_packet(bundle);
    visited = trace(bundle);
  }
  [[unroll]] for (uint r = 0u; r < RAYS; ++r) {
    bool is_hit = hits[r].triangle != NO_TRIANGLE && is_given(rays[r], hits[r]);
    seen[r * LANES + lane()] = is_hit ? hits[r].triangle : NO_TRIANGLE;
    ray_count += packet_ray(r) < args.ray_count ? 1u : 0u;
    hit_count += is_hit ? 1u : 0u;
  }
  shade(film, args.lighting.at[0]);
  COUNT_INTO(args.counters.at[0].rays, ray_count)
  COUNT_INTO(args.counters.at[0].hits, hit_count)
  COUNT_INTO(args.counters.at[0].steps, ray_count * visited)
}
