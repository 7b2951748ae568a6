// In:  a BVH2 over instances, those of their meshes, and rays. Out: the closest hit of each, as instance and triangle:
// that of the triangles that gather_triangles makes of each mesh by each transform. The heights of the trees are
// checked against the stack.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/instances.h"
#include "lib/ray_words.glsl"
#include "lib/trace_counters.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceInstancesArgs args; };
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;
layout(constant_id = 1) const uint TRACE_STACK = TRACE_STACK_LIMIT;  // entries
layout(constant_id = 2) const bool TRACE_COUNTS_RAYS = false;  // the steps of each are kept
const uint TRACE_TRIANGLE_TEST = TRIANGLE_WATERTIGHT;
const uint TRACE_BOX_TEST = BOX_ROBUST;

#include "lib/walk_instances.glsl"

// Steps; the hit of the ray is improved.
uint trace(uint i, inout Hit so_far, inout uint so_far_instance) {
  Ray given = load_ray(args.rays, i);
  TraceRay ray;
  if (!prepare_ray(given, ray)) return 0u;
  Node root = args.nodes.at[0];
  approach_scene(Aabb(root.box_min, root.box_max), ray);
  InstanceHit before = InstanceHit(prepared_hit(ray, so_far), so_far_instance);
  InstanceHit closest = before;
  InstanceWalk walk = walk_instances(TwoLevels(args.nodes, args.mesh_nodes, args.mesh_triangles, args.meshes,
                                               args.placed, args.transforms), ray, closest);
  if (is_unfinished(walk)) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  bool is_new = closest.instance != before.instance || closest.hit.triangle != before.hit.triangle;
  if (!is_new || !is_given(ray, closest.hit)) return walk.steps;
  so_far.triangle = NO_TRIANGLE;  // whatever triangle of another instance it was
  keep_given(ray, given, closest.hit, so_far);
  so_far_instance = closest.instance;
  return walk.steps;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < args.ray_count;
  uint instances = args.state.at[0].active_count;
  if (instances != 0u && args.nodes.at[0].height + args.mesh_height.at[0] > TRACE_STACK) {
    atomicOr(args.state.at[0].error_word, ERROR_TREE_TOO_DEEP);
    return;
  }
  uint steps = 0u;
  bool has_hit = false;
  if (present) {
    Hit so_far = load_hit(args.hits, i);
    uint instance = so_far.triangle == NO_TRIANGLE ? NO_INSTANCE : args.hit_instances.at[i];
    if (instances != 0u) steps = trace(i, so_far, instance);
    store_hit(args.hits, i, so_far);
    args.hit_instances.at[i] = instance;
    has_hit = so_far.triangle != NO_TRIANGLE;
    if (TRACE_COUNTS_RAYS) args.ray_steps.at[i] = steps;
  }
  COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].steps, steps)
}
