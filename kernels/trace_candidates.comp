// In:  a BVH2 and rays. Out: the leaves whose boxes each ray meets, see TraceCandidatesArgs. All of them are counted,
// so every node that a ray meets is visited; in which order does not matter. A ray's list is kept in order by insertion.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/count_error.glsl"
#include "lib/node_words.glsl"
#include "lib/ray_words.glsl"
#include "lib/search.glsl"
#include "lib/trace_counters.glsl"

layout(local_size_x = TRACE_GROUP) in;
layout(push_constant, scalar) uniform Push { TraceCandidatesArgs args; };
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // of all loops
layout(constant_id = 1) const uint TRACE_STACK = TRACE_STACK_LIMIT;
layout(constant_id = 2) const bool TRACE_MASKED = true;

const uint TRACE_BOX_TEST = BOX_ROBUST;

#include "lib/intersect_box.glsl"

// A ray on its way.
struct Collection {
  TraceRay ray;
  float t_min, t_max;  // as given
  float limit;         // t_max of the prepared ray
  Sight sight;
  uint first;  // of the ray's list
  uint count;
};

uint stack_pair[TRACE_STACK];
uint turns = 0u;

bool comes_before(BoxCandidate a, BoxCandidate b) {
  return a.t_enter < b.t_enter || (a.t_enter == b.t_enter && a.primitive < b.primitive);
}

// Where the list is full the last one goes.
void insert(BoxCandidate candidate, inout Collection c) {
  uint kept = min(c.count, args.capacity);
  ++c.count;
  uint place = min(kept, args.capacity - 1u);
  if (args.capacity == 0u) return;
  if (kept == args.capacity && !comes_before(candidate, args.candidates.at[c.first + place])) return;
  [[dont_unroll]] while (place != 0u && turns < TRACE_MAX_TURNS) {
    BoxCandidate before = args.candidates.at[c.first + place - 1u];
    if (!comes_before(candidate, before)) break;
    ++turns;
    args.candidates.at[c.first + place] = before;
    --place;
  }
  args.candidates.at[c.first + place] = candidate;
}

// Where the ray enters, as the ray as given has it.
float given_enter(Collection c, float enter) {
  precise float t = (enter + c.ray.moved) * c.ray.scale;
  return t;
}

// Whether the node is an internal one that the ray meets.
bool visit(Node node, inout Collection c) {
  float enter = c.ray.t_min;
  if (!intersect_box(c.ray, node.box_min, node.box_max, c.limit, enter)) return false;
  if (node.height != 0u) return true;
  float t = given_enter(c, enter);
  if (t == uintBitsToFloat(0x7f800000u) || (TRACE_MASKED && !sees(c.sight, node.child, false))) return false;
  insert(BoxCandidate(node.child, t < c.t_min ? c.t_min : (t > c.t_max ? c.t_max : t)), c);
  return false;
}

// Steps taken.
uint collect(inout Collection c) {
  uint top = 0u, steps = 0u;
  Node root = args.nodes.at[0];
  if (visit(root, c)) stack_pair[top++] = root.child;
  [[dont_unroll]] while (top != 0u && turns < TRACE_MAX_TURNS) {
    ++turns;
    ++steps;
    uint pair = stack_pair[--top];
    Node left = load_node(args.nodes, pair), right = load_node(args.nodes, pair + 1u);
    if (visit(left, c)) stack_pair[top++] = left.child;
    if (visit(right, c)) stack_pair[top++] = right.child;
  }
  if (top != 0u || turns >= TRACE_MAX_TURNS) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  return steps;
}

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
  Collection c;
  c.count = 0u;
  Ray given;
  if (present) given = load_ray(args.rays, i);
  if (present && has_tree && prepare_ray(given, c.ray)) {
    c.t_min = given.t_min;
    c.t_max = given.t_max;
    c.sight = Sight(args.primitive_flags, args.ray_mask);
    if (TRACE_MASKED) c.sight.mask = mask_of(args.ray_masks, args.ray_mask, i);
    c.first = i * args.capacity;
    Node root = args.nodes.at[0];
    approach_scene(Aabb(root.box_min, root.box_max), c.ray);
    c.limit = prepared_hit(c.ray, Hit(given.t_max, NO_TRIANGLE, 0.0, 0.0)).t;
    steps = collect(c);
  }
  if (present) args.candidate_counts.at[i] = c.count;
  COUNT_INTO(args.counters.at[0].rays, present ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].hits, c.count != 0u ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].steps, steps)
}
