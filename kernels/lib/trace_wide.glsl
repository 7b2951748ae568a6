// The main of trace_wide and trace_wide_alpha, which have `args` before.
#include "ray_words.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // as in trace_closest
layout(constant_id = 1) const bool TRACE_MASKED = true;            // as in trace_closest
layout(constant_id = 2) const bool TRACE_COUNTS_RAYS = false;      // each has the steps of its packet

#include "wide_packet.glsl"

uint given_triangle[RAYS];  // of the hits so far
uint masks[RAYS];
uint ray_count;
#ifdef TRACE_ALPHA
uint alpha_keys[RAYS];

bool packet_passes(uint r, Hit hit) { return lets_through(hit, alpha_keys[r]); }
#endif

bool packet_sees(uint r, uint triangle) {
  return !TRACE_MASKED || sees(Sight(args.primitive_flags, masks[r]), triangle, false);
}

uint ray_index(uint r) { return gl_WorkGroupID.x * TRACE_PACKET + r * LANES + lane(); }

void prepare(uint r, Aabb scene, inout RayBundle bundle) {
  Ray given;
  Hit so_far = Hit(0.0, NO_TRIANGLE, 0.0, 0.0);
  bool sound = ray_index(r) < ray_count;
  if (sound) so_far = load_hit(args.hits, ray_index(r));
  given_triangle[r] = so_far.triangle;
  if (sound) given = load_ray(args.rays, ray_index(r));
  if (TRACE_MASKED && sound) masks[r] = mask_of(args.ray_masks, args.ray_mask, ray_index(r));
  sound = sound && prepare_ray(given, rays[r]);
  if (sound) {
    approach_scene(scene, rays[r]);
#ifdef TRACE_ALPHA
    alpha_keys[r] = alpha_key(given);
#endif
    hits[r] = prepared_hit(rays[r], so_far);
    add_to_bundle(rays[r], bundle);
  } else {
    leave_out(r);
    hits[r].triangle = so_far.triangle;
  }
}

// Writes the new hits. How many rays there are, and how many of them hit.
uvec2 keep_hits() {
  uvec2 counts = uvec2(0u);
  [[unroll]] for (uint r = 0u; r < RAYS; ++r) {
    uint i = ray_index(r);
    if (hits[r].triangle != given_triangle[r]) {
      Hit so_far = load_hit(args.hits, i);
      keep_given(rays[r], load_ray(args.rays, i), hits[r], so_far);
      store_hit(args.hits, i, so_far);
      given_triangle[r] = so_far.triangle;
    }
    counts += uvec2(i < ray_count ? 1u : 0u, given_triangle[r] != NO_TRIANGLE ? 1u : 0u);
  }
  return counts;
}

void main() {
  ray_count = counted(args.count_at, args.ray_count);
  if (gl_GlobalInvocationID.x == 0u) note_ray_count(args.state, args.count_at, args.ray_count);
  uint visited = 0u;
  Node root = Node(vec3(0.0), 0u, vec3(0.0), 0u);
  bool has_tree = args.wide_counts.at[0].node_count != 0u;
  if (has_tree) root = args.nodes.at[0];
  RayBundle bundle = empty_bundle();
  [[unroll]] for (uint r = 0u; r < RAYS; ++r) prepare(r, Aabb(root.box_min, root.box_max), bundle);
  if (has_tree) {
    bind_packet(bundle);
    visited = trace(bundle);
  }
  uvec2 counts = keep_hits();
  if (TRACE_COUNTS_RAYS) {
    [[unroll]] for (uint r = 0u; r < RAYS; ++r)
      if (ray_index(r) < ray_count) args.ray_steps.at[ray_index(r)] = visited;
  }
  COUNT_INTO(args.counters.at[0].rays, counts.x)
  COUNT_INTO(args.counters.at[0].hits, counts.y)
  COUNT_INTO(args.counters.at[0].steps, counts.x * visited)
}
