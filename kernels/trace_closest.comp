// In:  a BVH2 and rays. Out: the closest hit of each. Depth-first, the nearer child first; a pair of children is one
// 64-byte read. The height of the tree bounds the stack, and is checked against it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/node_words.glsl"
#include "lib/ray_words.glsl"
#include "lib/trace_counters.glsl"
#include "lib/trace_ray.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceClosestArgs args; };
// Turns of the loop, each of TRACE_VISITS pairs; a tree has fewer pairs than triangles, so this binds only on a driver
// that ends long loops by itself.
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;
layout(constant_id = 1) const uint TRACE_VISITS = 1u;
// As in the arguments.
layout(constant_id = 2) const uint TRACE_STACK = TRACE_STACK_LIMIT;  // entries
layout(constant_id = 3) const uint TRACE_TRIANGLE_TEST = TRIANGLE_FAST;
layout(constant_id = 4) const uint TRACE_BOX_TEST = BOX_FAST;

#include "lib/intersect_box.glsl"
#include "lib/intersect_triangle.glsl"

const uint NO_PAIR = 0u;  // the root is no child

struct Traversal {
  uint pair;  // first of the two children to visit next
  uint top;
  uint steps;
};

uint stack_pair[TRACE_STACK];
float stack_enter[TRACE_STACK];

bool visit_child(Node child, TraceRay ray, inout Hit hit, out float enter) {
  enter = ray.t_min;
  if (!intersect_box(ray, child.box_min, child.box_max, hit.t, enter)) return false;
  if (child.height != 0u) return true;
  intersect_triangle(ray, args.triangles.at[child.child], child.child, hit);
  return false;
}

void visit_pair(TraceRay ray, inout Hit hit, inout Traversal state) {
  Node left = load_node(args.nodes, state.pair), right = load_node(args.nodes, state.pair + 1u);
  float left_enter, right_enter;
  bool go_left = visit_child(left, ray, hit, left_enter);
  bool go_right = visit_child(right, ray, hit, right_enter);
  go_left = go_left && left_enter <= hit.t;  // the right child may have been a closer leaf
  ++state.steps;
  if (go_left && go_right) {
    bool left_first = left_enter <= right_enter;
    stack_pair[state.top] = left_first ? right.child : left.child;
    stack_enter[state.top] = left_first ? right_enter : left_enter;
    ++state.top;
    state.pair = left_first ? left.child : right.child;
  } else {
    state.pair = go_left ? left.child : (go_right ? right.child : NO_PAIR);
  }
}

void pop_pair(Hit hit, inout Traversal state) {
  --state.top;
  if (stack_enter[state.top] <= hit.t) state.pair = stack_pair[state.top];
}

// Steps taken.
uint trace(TraceRay ray, inout Hit hit) {
  Traversal state = Traversal(NO_PAIR, 0u, 0u);
  float enter;
  Node root = args.nodes.at[0];
  if (visit_child(root, ray, hit, enter)) state.pair = root.child;
  uint turns = 0u;
  [[dont_unroll]] while (turns < TRACE_MAX_TURNS && (state.pair != NO_PAIR || state.top != 0u)) {
    ++turns;
    [[unroll]] for (uint k = 0u; k < TRACE_VISITS; ++k) {
      if (state.pair == NO_PAIR && state.top != 0u) pop_pair(hit, state);
      if (state.pair != NO_PAIR) visit_pair(ray, hit, state);
    }
  }
  if (state.pair != NO_PAIR || state.top != 0u) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  return state.steps;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < args.ray_count;
  if (args.state.at[0].active_count != 0u && args.nodes.at[0].height > TRACE_STACK) {
    atomicOr(args.state.at[0].error_word, ERROR_TREE_TOO_DEEP);
    return;
  }
  uint steps = 0u;
  bool has_hit = false;
  if (present && args.state.at[0].active_count != 0u) {
    Ray given = load_ray(args.rays, i);
    Hit so_far = load_hit(args.hits, i);
    TraceRay ray;
    if (prepare_ray(given, ray)) {
      Node root = args.nodes.at[0];
      Aabb box = Aabb(root.box_min, root.box_max);
      approach_scene(box, ray);
      Hit hit = prepared_hit(ray, so_far);
      steps = trace(ray, hit);
      keep_given(ray, given, hit, so_far);
      store_hit(args.hits, i, so_far);
    }
    has_hit = so_far.triangle != NO_TRIANGLE;
  }
  COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].hits, has_hit ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].steps, steps)
}
