// In:  a wide tree and rays. Out: the closest hit of each, the same as that of trace_closest.
//
// Each invocation walks with a ray of its own, nearest child first: Ylitie, Karras and Laine 2017. A subgroup visits
// nodes until too few of its rays need one, then tests one triangle for each ray that waits for that: the while-while
// loop of Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs". An invocation whose ray has
// ended takes the next one of the subgroup's block, as soon as some others have ended too: Aila, Laine and Karras 2012,
// the addendum. On CPU devices it walks with two rays in turns, so that a node is on its way from memory while another
// one's children are tested. No ray's walk depends on the others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"
#include "lib/ray_words.glsl"
#include "lib/subgroup.glsl"
#include "lib/trace_counters.glsl"
#include "lib/trace_ray.glsl"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { TraceWideArgs args; };
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // as in trace_closest

const uint TRACE_TRIANGLE_TEST = TRIANGLE_WATERTIGHT;
const uint RAYS = LANES_IN_STEP ? 2u : 1u;             // of an invocation; on GPUs other subgroups hide the waiting
const uint LEAST_WALKING = LANES * RAYS / 2u;          // rays for which nodes are visited while others wait
const uint ENOUGH_IDLE = (LANES * RAYS + 1u) / 2u;     // ended rays that are replaced together

#include "lib/grid_ray.glsl"
#include "lib/intersect_triangle.glsl"
#include "lib/triangle_words.glsl"
#include "lib/wide_keys.glsl"

// What the walk does next: visit a node or test a triangle, as a child word says; or one of these.
const uint NEXT_CHILD = 0xfffffffeu;  // take the next child of the list
const uint NO_RAY = WIDE_EMPTY;

// Children to be visited, nearest first, 16 bits each: 13 bits of the key's distance, 8 of them a binade's, then the
// child.
struct ChildList {
  uint a, b, c, d;  // the lowest half of `a` comes next; NO_CHILD is beyond every distance
};

const uint NO_CHILD = 0xffffu;

// A ray on its way. No ray: next is NO_RAY.
struct Walk {
  TraceRay ray;
  GridRay grid;
  Hit hit;
  int limit;  // distance of the hit
  uint ray_index;
  uint next;
  uint node;  // whose children are listed
  ChildList list;
  uint top;  // of its stack
};

Walk walks[RAYS];
uint visited = 0u;
uint turns = 0u;

// One for each level with children still to be visited; of the k-th ray from k * WIDE_MAX_HEIGHT on.
uint64_t stack_node[RAYS * WIDE_MAX_HEIGHT];  // and `a`
uint64_t stack_list[RAYS * WIDE_MAX_HEIGHT];  // `b` and `c`
uint stack_rest[RAYS * WIDE_MAX_HEIGHT];      // `d`

uint short_key(uint key) { return (key >> 12 & 0xfff8u) | (key & 7u); }
uint short_keys(uint first, uint second) { return short_key(first) | short_key(second) << 16; }

bool lists_any(Walk w) {
  uint nearest = w.list.a & 0xffffu;
  return nearest != NO_CHILD && nearest <= short_key(uint(w.limit) | 7u);
}

void push_list(inout Walk w, uint k) {
  uint level = k * WIDE_MAX_HEIGHT + w.top++;
  stack_node[level] = packUint2x32(uvec2(w.node, w.list.a));
  stack_list[level] = packUint2x32(uvec2(w.list.b, w.list.c));
  stack_rest[level] = w.list.d;
}

void pop_list(inout Walk w, uint k) {
  uint level = k * WIDE_MAX_HEIGHT + --w.top;
  uvec2 entry = unpackUint2x32(stack_node[level]), more = unpackUint2x32(stack_list[level]);
  w.node = entry.x;
  w.list = ChildList(entry.y, more.x, more.y, stack_rest[level]);
}

ChildList without_first(ChildList list) {
  return ChildList(list.a >> 16 | list.b << 16, list.b >> 16 | list.c << 16, list.c >> 16 | list.d << 16,
                   list.d >> 16 | NO_CHILD << 16);
}

void take_child(inout Walk w, uint k) {
  if (!lists_any(w) && w.top != 0u) pop_list(w, k);
  if (lists_any(w)) {
    w.next = args.wide_nodes.at[w.node].child[w.list.a & 7u];
    // An empty child has an inverted box, which a ray may meet where the node is smaller than the room for rounding.
    if (w.next == WIDE_EMPTY) w.next = NEXT_CHILD;
    w.list = without_first(w.list);
  } else if (w.top == 0u) {
    w.next = NO_RAY;
  }
}

bool is_at_node(Walk w) { return w.next < WIDE_LEAF; }
bool walks_on(Walk w) { return w.next == NEXT_CHILD || is_at_node(w); }
bool has_ray(Walk w) { return w.next != NO_RAY; }
uint count_of(bool x) { return subgroupBallotBitCount(subgroupBallot(x)); }

void visit_node(inout Walk w, NodeWords words, uint k) {
  if (lists_any(w)) push_list(w, k);
  w.node = w.next;
  w.next = NEXT_CHILD;
  ++visited;
  uint key[WIDE_CHILDREN];
  find_keys(w.grid, words, w.limit, key);
  sort_keys(key);
  w.list = ChildList(short_keys(key[0], key[1]), short_keys(key[2], key[3]), short_keys(key[4], key[5]),
                     short_keys(key[6], key[7]));
}

// Every ray that walks goes on by a node. Returns how many of the subgroup's still walk.
uint step_walks() {
  [[unroll]] for (uint k = 0u; k < RAYS; ++k)
    if (walks[k].next == NEXT_CHILD) take_child(walks[k], k);
  NodeWords words[RAYS];  // of node 0 for rays that are at none; without a tree that is what follows the slot
  [[unroll]] for (uint k = 0u; k < RAYS; ++k)
    words[k] = load_node_words(is_at_node(walks[k]) ? walks[k].next : 0u);
  uint walking = 0u;
  [[unroll]] for (uint k = 0u; k < RAYS; ++k) {
    if (is_at_node(walks[k])) visit_node(walks[k], words[k], k);
    walking += count_of(walks_on(walks[k]));
  }
  return walking;
}

void test_triangle(inout Walk w) {
  uint triangle = w.next & ~WIDE_LEAF;
  intersect_triangle(w.ray, load_triangle(args.triangles, triangle), triangle, w.hit);
  w.limit = grid_distance(w.grid, w.hit.t);
  w.next = NEXT_CHILD;
}

// Every ray that waits for a triangle tests it. Returns how many of the subgroup's have ended or were none.
uint test_triangles() {
  uint idle = 0u;
  [[unroll]] for (uint k = 0u; k < RAYS; ++k) {
    if (has_ray(walks[k]) && !walks_on(walks[k])) test_triangle(walks[k]);
    idle += count_of(!has_ray(walks[k]));
  }
  return idle;
}

// Until so many rays have ended.
void walk(uint enough) {
  [[dont_unroll]] do {
    [[dont_unroll]] do {
      ++turns;
    } while (step_walks() >= LEAST_WALKING && turns < TRACE_MAX_TURNS);
    ++turns;
  } while (test_triangles() < enough && turns < TRACE_MAX_TURNS);
}

const uint NO_INDEX = 0xffffffffu;

// Returns 1 if the ray that has ended hit something.
uint keep_hit(inout Walk w) {
  Hit so_far = load_hit(args.hits, w.ray_index);
  keep_given(w.ray, load_ray(args.rays, w.ray_index), w.hit, so_far);
  store_hit(args.hits, w.ray_index, so_far);
  w.ray_index = NO_INDEX;
  return so_far.triangle != NO_TRIANGLE ? 1u : 0u;
}

// Returns 1 for a ray that hits nothing in this tree, and has hit something before.
uint take_ray(inout Walk w, uint index, bool has_tree, Aabb scene) {
  Ray given = load_ray(args.rays, index);
  Hit so_far = load_hit(args.hits, index);
  if (!has_tree || !prepare_ray(given, w.ray)) return so_far.triangle != NO_TRIANGLE ? 1u : 0u;
  approach_scene(scene, w.ray);
  prepare_grid_ray(w.ray, scene, w.grid);
  w.hit = prepared_hit(w.ray, so_far);
  w.limit = grid_distance(w.grid, w.hit.t);
  w.ray_index = index;
  w.next = 0u;
  w.list.a = NO_CHILD;
  return 0u;
}

void main() {
  uint first = gl_WorkGroupID.x * TRACE_BLOCK, end = min(first + TRACE_BLOCK, args.ray_count), taken = first;
  Node root = Node(vec3(0.0), 0u, vec3(0.0), 0u);
  bool has_tree = args.wide_counts.at[0].node_count != 0u;
  if (has_tree) root = args.nodes.at[0];
  uint hit_count = 0u;
  [[unroll]] for (uint k = 0u; k < RAYS; ++k) {
    walks[k].next = NO_RAY;
    walks[k].ray_index = NO_INDEX;
    walks[k].top = 0u;
  }
  bool going = true;
  [[dont_unroll]] while (going) {
    ++turns;
    going = false;
    [[unroll]] for (uint k = 0u; k < RAYS; ++k) {
      bool idle = !has_ray(walks[k]);
      if (idle && walks[k].ray_index != NO_INDEX) hit_count += keep_hit(walks[k]);
      uvec4 idle_lanes = subgroupBallot(idle);
      uint index = taken + subgroupBallotExclusiveBitCount(idle_lanes);
      taken = min(taken + subgroupBallotBitCount(idle_lanes), end);
      if (idle && index < end) hit_count += take_ray(walks[k], index, has_tree, Aabb(root.box_min, root.box_max));
      going = going || subgroupAny(has_ray(walks[k]));
    }
    walk(taken < end ? ENOUGH_IDLE : LANES * RAYS);
    going = (going || taken < end) && turns < TRACE_MAX_TURNS;
  }
  bool unfinished = taken < end;
  [[unroll]] for (uint k = 0u; k < RAYS; ++k) unfinished = unfinished || walks[k].ray_index != NO_INDEX;
  if (unfinished) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  COUNT_INTO(args.counters.at[0].rays, lane() == 0u ? end - first : 0u)
  COUNT_INTO(args.counters.at[0].hits, hit_count)
  COUNT_INTO(args.counters.at[0].steps, visited)
}
