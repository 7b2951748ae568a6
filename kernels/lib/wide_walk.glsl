// Takes a ray through a wide tree, nearest child first: Ylitie, Karras and Laine 2017. A ray that looks for any hit takes
// the children as they come: to sort them costs more than it saves. One step at a time, so that a kernel may let rays
// take turns. Needs the constants TRACE_RAYS, walks of an invocation that are on their way at once,
// and TRACE_TRIANGLE_TEST, which is TRIANGLE_WATERTIGHT.
#ifndef COPPICE_LIB_WIDE_WALK
#define COPPICE_LIB_WIDE_WALK
#include "intersect_triangle.glsl"
#include "search.glsl"
#include "triangle_words.glsl"
#include "wide_keys.glsl"

struct WideTree {
  WideNodeBuffer wide_nodes;
  TriangleBuffer triangles;
};

// What the walk does next: visit a node or test a triangle, as a child word says; or one of these.
const uint NEXT_CHILD = 0xfffffffeu;  // take the next child of the list
const uint NO_RAY = WIDE_EMPTY;

// Children to be visited, nearest first, 16 bits each: 13 bits of the key's distance, 8 of them a binade's, then the
// child. For any hit `a` alone is used, with a bit for each child.
struct ChildList {
  uint a, b, c, d;  // the lowest half of `a` comes next; NO_CHILD is beyond every distance
};

const uint NO_CHILD = 0xffffu;

// A ray on its way. No ray: next is NO_RAY.
struct Walk {
  TraceRay ray;
  GridRay grid;
  Sight sight;
  Hit hit;
  int limit;  // distance of the hit
  uint ray_index;
  uint next;
  uint node;  // whose children are listed
  ChildList list;
  uint top;  // of its stack
#ifdef TRACE_ALPHA
  uint alpha_key;
#endif
};

// One for each level with children still to be visited; of the k-th walk from k * WIDE_MAX_HEIGHT on.
uint64_t stack_node[TRACE_RAYS * WIDE_MAX_HEIGHT];  // and `a`
uint64_t stack_list[TRACE_RAYS * WIDE_MAX_HEIGHT];  // `b` and `c`
uint stack_rest[TRACE_RAYS * WIDE_MAX_HEIGHT];      // `d`

uint short_key(uint key) { return (key >> 12 & 0xfff8u) | (key & 7u); }
uint short_keys(uint first, uint second) { return short_key(first) | short_key(second) << 16; }

bool lists_any(const Search search, Walk w) {
  if (search.any) return w.list.a != 0u;
  uint nearest = w.list.a & 0xffffu;
  return nearest != NO_CHILD && nearest <= short_key(uint(w.limit) | 7u);
}

void push_list(const Search search, inout Walk w, uint k) {
  uint level = k * WIDE_MAX_HEIGHT + w.top++;
  stack_node[level] = packUint2x32(uvec2(w.node, w.list.a));
  if (search.any) return;
  stack_list[level] = packUint2x32(uvec2(w.list.b, w.list.c));
  stack_rest[level] = w.list.d;
}

void pop_list(const Search search, inout Walk w, uint k) {
  uint level = k * WIDE_MAX_HEIGHT + --w.top;
  uvec2 entry = unpackUint2x32(stack_node[level]);
  w.node = entry.x;
  w.list.a = entry.y;
  if (search.any) return;
  uvec2 more = unpackUint2x32(stack_list[level]);
  w.list = ChildList(entry.y, more.x, more.y, stack_rest[level]);
}

ChildList without_first(ChildList list) {
  return ChildList(list.a >> 16 | list.b << 16, list.b >> 16 | list.c << 16, list.c >> 16 | list.d << 16,
                   list.d >> 16 | NO_CHILD << 16);
}

void take_child(WideTree tree, const Search search, inout Walk w, uint k) {
  if (!lists_any(search, w) && w.top != 0u) pop_list(search, w, k);
  if (lists_any(search, w)) {
    uint child = search.any ? uint(findLSB(w.list.a)) : w.list.a & 7u;
    w.next = tree.wide_nodes.at[w.node].child[child];
    // An empty child has an inverted box, which a ray may meet where the node is smaller than the room for rounding.
    if (w.next == WIDE_EMPTY) w.next = NEXT_CHILD;
    if (search.any) w.list.a &= w.list.a - 1u;
    else w.list = without_first(w.list);
  } else if (w.top == 0u) {
    w.next = NO_RAY;
  }
}

bool is_at_node(Walk w) { return w.next < WIDE_LEAF; }
bool walks_on(Walk w) { return w.next == NEXT_CHILD || is_at_node(w); }
bool has_ray(Walk w) { return w.next != NO_RAY; }

void visit_node(const Search search, inout Walk w, NodeWords words, uint k) {
  if (lists_any(search, w)) push_list(search, w, k);
  w.node = w.next;
  w.next = NEXT_CHILD;
  uint key[WIDE_CHILDREN];
  find_keys(w.grid, words, w.limit, key);
  if (search.any) {
    w.list.a = 0u;
    [[unroll]] for (uint child = 0u; child < WIDE_CHILDREN; ++child)
      w.list.a |= key[child] != NO_KEY ? 1u << child : 0u;
    return;
  }
  sort_keys(key);
  w.list = ChildList(short_keys(key[0], key[1]), short_keys(key[2], key[3]), short_keys(key[4], key[5]),
                     short_keys(key[6], key[7]));
}

void test_triangle(WideTree tree, const Search search, inout Walk w) {
  uint triangle = w.next & ~WIDE_LEAF;
  w.next = NEXT_CHILD;
  if (search.masked && !sees(w.sight, triangle, search.any)) return;
  Hit before = w.hit;
  intersect_triangle(w.ray, load_triangle(tree.triangles, triangle), triangle, w.hit);
#ifdef TRACE_ALPHA
  if (w.hit.triangle != before.triangle && lets_through(w.hit, w.alpha_key)) w.hit = before;
#endif
  if (search.any) {
    if (!is_given(w.ray, w.hit)) w.hit = before;
    if (w.hit.triangle == NO_TRIANGLE) return;
    w.next = NO_RAY;
    w.top = 0u;
  } else {
    w.limit = grid_distance(w.grid, w.hit.t);
  }
}

// At the root. `hit` is one of the ray as given.
void start_walk(Aabb scene, const Search search, Hit hit, inout Walk w) {
  approach_scene(scene, w.ray);
  prepare_grid_ray(w.ray, scene, w.grid);
  w.hit = prepared_hit(w.ray, hit);
  w.limit = grid_distance(w.grid, w.hit.t);
  w.next = 0u;
  w.list.a = search.any ? 0u : NO_CHILD;
}

#endif
