// The main of trace_any and trace_any_alpha, which have `args` and its includes before.
#include "count_error.glsl"
#include "ray_words.glsl"
#include "trace_counters.glsl"

layout(local_size_x = TRACE_GROUP) in;
// As in trace_closest.
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;
layout(constant_id = 1) const uint TRACE_VISITS = 1u;
layout(constant_id = 2) const uint TRACE_STACK = TRACE_STACK_LIMIT;
layout(constant_id = 3) const uint TRACE_TRIANGLE_TEST = TRIANGLE_FAST;
layout(constant_id = 4) const uint TRACE_BOX_TEST = BOX_FAST;
layout(constant_id = 5) const bool TRACE_MASKED = true;

#include "walk_pairs.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < counted(args.count_at, args.ray_count);
  if (i == 0u) note_ray_count(args.state, args.count_at, args.ray_count);
  bool has_tree = args.state.at[0].active_count != 0u;
  if (has_tree && args.nodes.at[0].height > TRACE_STACK) {
    atomicOr(args.state.at[0].error_word, ERROR_TREE_TOO_DEEP);
    has_tree = false;
  }
  uint steps = 0u;
  bool has_hit = false;
  TraceRay ray;
  Ray given;
  if (present) given = load_ray(args.rays, i);
  if (present && has_tree && prepare_ray(given, ray)) {
#ifdef TRACE_ALPHA
    walk_alpha_key = alpha_key(given);
#endif
    Sight sight = Sight(args.primitive_flags, args.ray_mask);
    if (TRACE_MASKED) sight.mask = mask_of(args.ray_masks, args.ray_mask, i);
    Node root = args.nodes.at[0];
    approach_scene(Aabb(root.box_min, root.box_max), ray);
    Hit hit = prepared_hit(ray, Hit(given.t_max, NO_TRIANGLE, 0.0, 0.0));
    PairWalk walk =
        walk_pairs(BinaryTree(args.nodes, args.triangles), ray, sight, Search(true, TRACE_MASKED), hit);
    if (is_unfinished(walk)) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
    steps = walk.steps;
    has_hit = hit.triangle != NO_TRIANGLE;
  }
  if (present) args.any_hits.at[i] = has_hit ? 1u : 0u;
  COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].steps, steps)
}
