// A block of rays that a subgroup takes through a wide tree, each by itself. The subgroup visits nodes until too few of
// its rays need one, then tests one triangle for each ray that waits for that: the while-while loop of Aila and Laine
// 2009, "Understanding the Efficiency of Ray Traversal on GPUs". An invocation whose ray has ended takes the next one
// of the block, as soon as some others have ended too: Aila, Laine and Karras 2012, the addendum. On CPU devices it
// walks with two rays in turns, so that a node is on its way from memory while another one's children are tested. No
// ray's walk depends on the others.
//
// Needs `args`, the constants TRACE_MAX_TURNS, TRACE_MASKED and TRACE_COUNTS_RAYS, and SEARCH, and after it the functions below.
#include "count_error.glsl"
#include "ray_words.glsl"
#include "subgroup.glsl"
#include "trace_counters.glsl"

const uint TRACE_TRIANGLE_TEST = TRIANGLE_WATERTIGHT;
const uint TRACE_RAYS = LANES_IN_STEP ? 2u : 1u;          // on GPUs other subgroups hide the waiting
const uint LEAST_WALKING = LANES * TRACE_RAYS / 2u;       // rays for which nodes are visited while others wait
const uint ENOUGH_IDLE = (LANES * TRACE_RAYS + 1u) / 2u;  // ended rays that are replaced together

#include "wide_walk.glsl"

// What a ray has hit before.
Hit hit_so_far(uint ray, Ray given);
// Of a walk that has ended, or of a ray that hits nothing in this tree. Whether the ray has a hit.
bool keep_hit(Walk w);
bool keep_miss(uint ray, Hit so_far);
// How many nodes it visited; only with TRACE_COUNTS_RAYS.
void keep_steps(uint ray, uint steps);

Walk walks[TRACE_RAYS];
uint ray_visited[TRACE_RAYS];  // of the rays on their way; only with TRACE_COUNTS_RAYS
uint visited = 0u;
uint turns = 0u;

uint count_of(bool x) { return subgroupBallotBitCount(subgroupBallot(x)); }

// Every ray that walks goes on by a node. Returns how many of the subgroup's still walk.
uint step_walks(WideTree tree) {
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k)
    if (walks[k].next == NEXT_CHILD) take_child(tree, SEARCH, walks[k], k);
  NodeWords words[TRACE_RAYS];  // of node 0 for rays that are at none; without a tree that is what follows the slot
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k)
    words[k] = load_node_words(tree.wide_nodes, is_at_node(walks[k]) ? walks[k].next : 0u);
  uint walking = 0u;
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k) {
    if (is_at_node(walks[k])) {
      ++visited;
      if (TRACE_COUNTS_RAYS) ++ray_visited[k];
      visit_node(SEARCH, walks[k], words[k], k);
    }
    walking += count_of(walks_on(walks[k]));
  }
  return walking;
}

// Every ray that waits for a triangle tests it. Returns how many of the subgroup's have ended or were none.
uint test_triangles(WideTree tree) {
  uint idle = 0u;
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k) {
    if (has_ray(walks[k]) && !walks_on(walks[k])) test_triangle(tree, SEARCH, walks[k]);
    idle += count_of(!has_ray(walks[k]));
  }
  return idle;
}

// Until so many rays have ended.
void walk(WideTree tree, uint enough) {
  [[dont_unroll]] do {
    [[dont_unroll]] do {
      ++turns;
    } while (step_walks(tree) >= LEAST_WALKING && turns < TRACE_MAX_TURNS);
    ++turns;
  } while (test_triangles(tree) < enough && turns < TRACE_MAX_TURNS);
}

const uint NO_INDEX = 0xffffffffu;

// Returns 1 for a ray that hits nothing in this tree, and has hit something before.
uint take_ray(inout Walk w, uint index, bool has_tree, Aabb scene) {
  Ray given = load_ray(args.rays, index);
  Hit so_far = hit_so_far(index, given);
  if (!has_tree || !prepare_ray(given, w.ray)) {
    if (TRACE_COUNTS_RAYS) keep_steps(index, 0u);
    return keep_miss(index, so_far) ? 1u : 0u;
  }
  w.sight = Sight(args.primitive_flags, args.ray_mask);
  if (TRACE_MASKED) w.sight.mask = mask_of(args.ray_masks, args.ray_mask, index);
  w.ray_index = index;
#ifdef TRACE_ALPHA
  w.alpha_key = alpha_key(given);
#endif
  start_walk(scene, SEARCH, so_far, w);
  return 0u;
}

void trace_block() {
  uint ray_count = counted(args.count_at, args.ray_count);
  if (gl_GlobalInvocationID.x == 0u) note_ray_count(args.state, args.count_at, args.ray_count);
  uint first = min(gl_WorkGroupID.x * TRACE_BLOCK, ray_count), end = min(first + TRACE_BLOCK, ray_count);
  uint taken = first;
  WideTree tree = WideTree(args.wide_nodes, args.triangles);
  Node root = Node(vec3(0.0), 0u, vec3(0.0), 0u);
  bool has_tree = args.wide_counts.at[0].node_count != 0u;
  if (has_tree) root = args.nodes.at[0];
  uint hit_count = 0u;
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k) {
    walks[k].next = NO_RAY;
    walks[k].ray_index = NO_INDEX;
    walks[k].top = 0u;
  }
  bool going = true;
  [[dont_unroll]] while (going) {
    ++turns;
    going = false;
    [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k) {
      bool idle = !has_ray(walks[k]);
      if (idle && walks[k].ray_index != NO_INDEX) {
        hit_count += keep_hit(walks[k]) ? 1u : 0u;
        if (TRACE_COUNTS_RAYS) keep_steps(walks[k].ray_index, ray_visited[k]);
        walks[k].ray_index = NO_INDEX;
      }
      uvec4 idle_lanes = subgroupBallot(idle);
      uint index = taken + subgroupBallotExclusiveBitCount(idle_lanes);
      taken = min(taken + subgroupBallotBitCount(idle_lanes), end);
      if (TRACE_COUNTS_RAYS && idle) ray_visited[k] = 0u;
      if (idle && index < end) hit_count += take_ray(walks[k], index, has_tree, Aabb(root.box_min, root.box_max));
      going = going || subgroupAny(has_ray(walks[k]));
    }
    walk(tree, taken < end ? ENOUGH_IDLE : LANES * TRACE_RAYS);
    going = (going || taken < end) && turns < TRACE_MAX_TURNS;
  }
  bool unfinished = taken < end;
  [[unroll]] for (uint k = 0u; k < TRACE_RAYS; ++k) unfinished = unfinished || walks[k].ray_index != NO_INDEX;
  if (unfinished) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  COUNT_INTO(args.counters.at[0].rays, lane() == 0u ? end - first : 0u)
  COUNT_INTO(args.counters.at[0].hits, hit_count)
  COUNT_INTO(args.counters.at[0].steps, visited)
}
