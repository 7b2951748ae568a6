// The main of trace_closest and trace_closest_alpha, which have `args` and its includes before.
#include "count_error.glsl"
#include "ray_words.glsl"
#include "trace_counters.glsl"

layout(local_size_x = TRACE_GROUP) in;
// Turns of the loop, each of TRACE_VISITS pairs; a tree has fewer pairs than triangles, so this binds only on a driver
// that ends long loops by itself.
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;
layout(constant_id = 1) const uint TRACE_VISITS = 1u;
// As in the arguments.
layout(constant_id = 2) const uint TRACE_STACK = TRACE_STACK_LIMIT;  // entries
layout(constant_id = 3) const uint TRACE_TRIANGLE_TEST = TRIANGLE_FAST;
layout(constant_id = 4) const uint TRACE_BOX_TEST = BOX_FAST;
layout(constant_id = 5) const bool TRACE_MASKED = true;  // false: every ray sees every primitive
layout(constant_id = 6) const bool TRACE_COUNTS_RAYS = false;  // the steps of each are kept

#include "walk_pairs.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < counted(args.count_at, args.ray_count);
  if (i == 0u) note_ray_count(args.state, args.count_at, args.ray_count);
  if (args.state.at[0].active_count != 0u && args.nodes.at[0].height > TRACE_STACK) {
    atomicOr(args.state.at[0].error_word, ERROR_TREE_TOO_DEEP);
    return;
  }
  uint steps = 0u;
  bool has_hit = false;
  if (present && args.state.at[0].active_count != 0u) {
    Ray given = load_ray(args.rays, i);
#ifdef TRACE_ALPHA
    walk_alpha_key = alpha_key(given);
#endif
    Hit so_far = load_hit(args.hits, i);
    TraceRay ray;
    if (prepare_ray(given, ray)) {
      Sight sight = Sight(args.primitive_flags, args.ray_mask);
      if (TRACE_MASKED) sight.mask = mask_of(args.ray_masks, args.ray_mask, i);
      Node root = args.nodes.at[0];
      approach_scene(Aabb(root.box_min, root.box_max), ray);
      Hit hit = prepared_hit(ray, so_far);
      PairWalk walk =
          walk_pairs(BinaryTree(args.nodes, args.triangles), ray, sight, Search(false, TRACE_MASKED), hit);
      if (is_unfinished(walk)) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
      steps = walk.steps;
      keep_given(ray, given, hit, so_far);
      store_hit(args.hits, i, so_far);
    }
    has_hit = so_far.triangle != NO_TRIANGLE;
  }
  if (TRACE_COUNTS_RAYS && present) args.ray_steps.at[i] = steps;
  COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].steps, steps)
}
