// In:  a wide tree and rays. Out: the closest hit of each, the same as that of trace_closest.
//
// Each invocation walks with a ray of its own, nearest child first: Ylitie, Karras and Laine 2017. A subgroup visits
// nodes until too few of its rays need one, then tests one triangle for each ray that waits for that: the while-while
// loop of Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs". An invocation whose ray has
// ended takes the next one of the subgroup's block, as soon as some others have ended too: Aila, Laine and Karras 2012,
// the addendum. No ray's walk depends on the others.
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
const uint LEAST_WALKING = LANES / 2u;            // rays for which nodes are visited while others wait
const uint ENOUGH_IDLE = (LANES + 1u) / 2u;       // invocations that take a new ray together

#include "lib/grid_ray.glsl"
#include "lib/intersect_triangle.glsl"
#include "lib/triangle_words.glsl"
#include "lib/wide_keys.glsl"

// What the walk does next: visit a node or test a triangle, as a child word says; or one of these.
const uint NEXT_CHILD = 0xfffffffeu;  // take the next child of the list
const uint NO_RAY = WIDE_EMPTY;

// Children to be visited, nearest first, 16 bits each: 13 bits of the distance, then the child.
struct ChildList {
  uint a, b, c, d;  // the lowest half of `a` comes next; NO_CHILD is beyond every distance
};

const uint NO_CHILD = 0xffffu;

TraceRay ray;
GridRay grid;
Hit hit;
int limit = 0;  // distance of the hit
uint ray_index;
uint next = NO_RAY;
uint node = 0u;  // whose children are listed
ChildList list;
uint top = 0u;
uint visited = 0u;
uint turns = 0u;

// One for each level with children still to be visited.
uint64_t stack_node[WIDE_MAX_HEIGHT];  // and `a`
uint64_t stack_list[WIDE_MAX_HEIGHT];  // `b` and `c`
uint stack_rest[WIDE_MAX_HEIGHT];      // `d`

uint short_key(uint key) { return (key >> 7 & 0xfff8u) | (key & 7u); }
uint short_keys(uint first, uint second) { return short_key(first) | short_key(second) << 16; }

// The limit may be no distance within the scene, where a range ends before it; then its short key may be any.
bool lists_any() {
  uint nearest = list.a & 0xffffu;
  return nearest != NO_CHILD && nearest <= short_key(uint(limit) | 7u);
}

void push_list() {
  stack_node[top] = packUint2x32(uvec2(node, list.a));
  stack_list[top] = packUint2x32(uvec2(list.b, list.c));
  stack_rest[top] = list.d;
  ++top;
}

void pop_list() {
  --top;
  uvec2 entry = unpackUint2x32(stack_node[top]), more = unpackUint2x32(stack_list[top]);
  node = entry.x;
  list = ChildList(entry.y, more.x, more.y, stack_rest[top]);
}

void take_child() {
  if (!lists_any() && top != 0u) pop_list();
  if (lists_any()) {
    next = args.wide_nodes.at[node].child[list.a & 7u];
    // An empty child has an inverted box, which a ray may meet where the node is smaller than the room for rounding.
    if (next == WIDE_EMPTY) next = NEXT_CHILD;
    list = ChildList(list.a >> 16 | list.b << 16, list.b >> 16 | list.c << 16, list.c >> 16 | list.d << 16,
                     list.d >> 16 | NO_CHILD << 16);
  } else if (top == 0u) {
    next = NO_RAY;
  }
}

void visit_node() {
  if (lists_any()) push_list();
  node = next;
  next = NEXT_CHILD;
  ++visited;
  uint key[WIDE_CHILDREN];
  find_keys(grid, node, limit, key);
  sort_keys(key);
  list = ChildList(short_keys(key[0], key[1]), short_keys(key[2], key[3]), short_keys(key[4], key[5]),
                   short_keys(key[6], key[7]));
}

void test_triangle() {
  uint triangle = next & ~WIDE_LEAF;
  intersect_triangle(ray, load_triangle(args.triangles, triangle), triangle, hit);
  limit = grid_distance(grid, hit.t);
  next = NEXT_CHILD;
}

bool has_ray() { return next != NO_RAY; }
bool walks() { return next == NEXT_CHILD || next < WIDE_LEAF; }
uint count_of(bool x) { return subgroupBallotBitCount(subgroupBallot(x)); }

// Until so many invocations have no ray.
void walk(uint enough) {
  uint idle;
  [[dont_unroll]] do {
    [[dont_unroll]] do {
      ++turns;
      if (next == NEXT_CHILD) take_child();
      if (next < WIDE_LEAF) visit_node();
    } while (count_of(walks()) >= LEAST_WALKING && turns < TRACE_MAX_TURNS);
    ++turns;
    if (has_ray() && !walks()) test_triangle();
    idle = count_of(!has_ray());
  } while (idle < enough && turns < TRACE_MAX_TURNS);
}

const uint NO_INDEX = 0xffffffffu;

// Returns 1 if the ray that has ended hit something.
uint keep_hit() {
  Hit so_far = load_hit(args.hits, ray_index);
  keep_given(ray, load_ray(args.rays, ray_index), hit, so_far);
  store_hit(args.hits, ray_index, so_far);
  ray_index = NO_INDEX;
  return so_far.triangle != NO_TRIANGLE ? 1u : 0u;
}

// Returns 1 for a ray that hits nothing in this tree, and has hit something before.
uint take_ray(uint index, bool has_tree, Aabb scene) {
  Ray given = load_ray(args.rays, index);
  Hit so_far = load_hit(args.hits, index);
  if (!has_tree || !prepare_ray(given, ray)) return so_far.triangle != NO_TRIANGLE ? 1u : 0u;
  approach_scene(scene, ray);
  prepare_grid_ray(ray, scene, grid);
  hit = prepared_hit(ray, so_far);
  limit = grid_distance(grid, hit.t);
  ray_index = index;
  next = 0u;
  list.a = NO_CHILD;
  return 0u;
}

void main() {
  uint first = gl_WorkGroupID.x * TRACE_BLOCK, end = min(first + TRACE_BLOCK, args.ray_count), taken = first;
  Node root = Node(vec3(0.0), 0u, vec3(0.0), 0u);
  bool has_tree = args.wide_counts.at[0].node_count != 0u;
  if (has_tree) root = args.nodes.at[0];
  uint hit_count = 0u;
  ray_index = NO_INDEX;
  bool going = true;
  [[dont_unroll]] while (going) {
    ++turns;
    if (!has_ray() && ray_index != NO_INDEX) hit_count += keep_hit();
    uvec4 idle = subgroupBallot(!has_ray());
    uint index = taken + subgroupBallotExclusiveBitCount(idle);
    taken = min(taken + subgroupBallotBitCount(idle), end);
    if (!has_ray() && index < end) hit_count += take_ray(index, has_tree, Aabb(root.box_min, root.box_max));
    going = subgroupAny(has_ray());
    walk(taken < end ? ENOUGH_IDLE : LANES);
    going = (going || taken < end) && turns < TRACE_MAX_TURNS;
  }
  if (ray_index != NO_INDEX || taken < end) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  COUNT_INTO(args.counters.at[0].rays, lane() == 0u ? end - first : 0u)
  COUNT_INTO(args.counters.at[0].hits, hit_count)
  COUNT_INTO(args.counters.at[0].steps, visited)
}
