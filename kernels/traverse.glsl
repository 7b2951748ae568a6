// Rays from a shader of your own through trees that Coppice has built; docs/traverse.md is the page about it.
//
//   #version 460
//   #extension GL_GOOGLE_include_directive : require
//   #include "coppice/traverse.glsl"
//
// The walks and the tests are those of trace_closest, trace_any and the kernels of wide trees: hits are the same bits.
// Include it before declarations of your own. It brings the names of interface/trace.h and of the files that are
// included below with it; what is meant to be called begins with Coppice or coppice_.
#ifndef COPPICE_TRAVERSE
#define COPPICE_TRAVERSE
#include "interface/trace.h"

// What you may define before the include: the entries of the stack of a walk through a binary tree. A tree of greater
// height is not walked, see coppice_fits.
#ifndef COPPICE_STACK
#define COPPICE_STACK TRACE_STACK_LIMIT
#endif

const uint TRACE_MAX_TURNS = 0xffffffffu;
const uint TRACE_VISITS = 1u;
const uint TRACE_STACK = COPPICE_STACK;
const uint TRACE_RAYS = 1u;
const uint TRACE_TRIANGLE_TEST = TRIANGLE_WATERTIGHT;
const uint TRACE_BOX_TEST = BOX_ROBUST;

#include "lib/walk_pairs.glsl"
#include "lib/wide_walk.glsl"

// Addresses of a tree, 32 bytes: may lie in your push constants.
struct CoppiceTree {
  NodeBuffer nodes;
  TriangleBuffer triangles;
  BuildStateBuffer state;      // no active triangles: nothing is hit
  UintBuffer primitive_flags;  // null: none
};

// The same for a tree with wide nodes, 40 bytes.
struct CoppiceWideTree {
  WideNodeBuffer wide_nodes;
  WideCountsBuffer wide_counts;  // no nodes: nothing is hit
  NodeBuffer nodes;              // the binary tree; only its root's box is read
  TriangleBuffer triangles;
  UintBuffer primitive_flags;
};

// Whether the tree can be walked. Where it cannot, its rays hit nothing; no tree is too high for TRACE_STACK_LIMIT that
// H-PLOC built, or PLOC of fewer than 2^22 triangles.
bool coppice_fits(CoppiceTree tree) {
  return tree.state.at[0].active_count == 0u || tree.nodes.at[0].height <= TRACE_STACK;
}

Hit coppice_miss(Ray ray) { return Hit(ray.t_max, NO_TRIANGLE, 0.0, 0.0); }

Hit coppice_search(CoppiceTree tree, Ray given, uint mask, const bool any) {
  Hit so_far = coppice_miss(given);
  TraceRay ray;
  if (tree.state.at[0].active_count == 0u || !coppice_fits(tree) || !prepare_ray(given, ray)) return so_far;
  Node root = tree.nodes.at[0];
  approach_scene(Aabb(root.box_min, root.box_max), ray);
  Hit hit = prepared_hit(ray, so_far);
  walk_pairs(BinaryTree(tree.nodes, tree.triangles), ray, Sight(tree.primitive_flags, mask), Search(any, true), hit);
  keep_given(ray, given, hit, so_far);
  return so_far;
}

Hit coppice_search(CoppiceWideTree tree, Ray given, uint mask, const bool any) {
  Hit so_far = coppice_miss(given);
  Walk walk;
  if (tree.wide_counts.at[0].node_count == 0u || !prepare_ray(given, walk.ray)) return so_far;
  Node root = tree.nodes.at[0];
  walk.sight = Sight(tree.primitive_flags, mask);
  walk.top = 0u;
  const Search search = Search(any, true);
  start_walk(Aabb(root.box_min, root.box_max), search, so_far, walk);
  WideTree nodes = WideTree(tree.wide_nodes, tree.triangles);
  [[dont_unroll]] while (has_ray(walk)) {
    if (walk.next == NEXT_CHILD) take_child(nodes, search, walk, 0u);
    if (is_at_node(walk)) visit_node(search, walk, load_node_words(tree.wide_nodes, walk.next), 0u);
    else if (has_ray(walk) && walk.next != NEXT_CHILD) test_triangle(nodes, search, walk);
  }
  keep_given(walk.ray, given, walk.hit, so_far);
  return so_far;
}

// The closest hit on a triangle whose mask has a bit in common with `mask`, opaque or not: triangle == NO_TRIANGLE
// where there is none. Of equally close ones the smallest index.
Hit coppice_trace_closest(CoppiceTree tree, Ray ray, uint mask) { return coppice_search(tree, ray, mask, false); }
Hit coppice_trace_closest(CoppiceWideTree tree, Ray ray, uint mask) { return coppice_search(tree, ray, mask, false); }

// Whether there is a hit on such a triangle that is opaque.
bool coppice_trace_any(CoppiceTree tree, Ray ray, uint mask) {
  return coppice_search(tree, ray, mask, true).triangle != NO_TRIANGLE;
}
bool coppice_trace_any(CoppiceWideTree tree, Ray ray, uint mask) {
  return coppice_search(tree, ray, mask, true).triangle != NO_TRIANGLE;
}

#endif
