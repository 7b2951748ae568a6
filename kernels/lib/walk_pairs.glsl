// Takes a ray through a BVH2 depth-first, the nearer child first; a pair of children is one 64-byte read. The height of
// the tree bounds the stack. Needs the constants TRACE_MAX_TURNS, TRACE_VISITS, TRACE_STACK, TRACE_TRIANGLE_TEST and
// TRACE_BOX_TEST, see trace_closest.comp.
#ifndef COPPICE_LIB_WALK_PAIRS
#define COPPICE_LIB_WALK_PAIRS
#include "intersect_box.glsl"
#include "intersect_triangle.glsl"
#include "node_words.glsl"
#include "search.glsl"
#include "trace_ray.glsl"

struct BinaryTree {
  NodeBuffer nodes;
  TriangleBuffer triangles;
};

const uint NO_PAIR = 0u;  // the root is no child

struct PairWalk {
  uint pair;  // first of the two children to visit next
  uint top;
  uint steps;
};

uint stack_pair[TRACE_STACK];
float stack_enter[TRACE_STACK];

#ifdef TRACE_ALPHA
uint walk_alpha_key;  // of the ray that walks
#endif

void test_leaf(BinaryTree tree, uint triangle, TraceRay ray, Sight sight, const Search search, inout Hit hit) {
  if (search.masked && !sees(sight, triangle, search.any)) return;
  Hit before = hit;
  intersect_triangle(ray, tree.triangles.at[triangle], triangle, hit);
  if (search.any && !is_given(ray, hit)) hit = before;
#ifdef TRACE_ALPHA
  if (hit.triangle != before.triangle && lets_through(hit, walk_alpha_key)) hit = before;
#endif
}

bool visit_child(BinaryTree tree, Node child, TraceRay ray, Sight sight, const Search search, inout Hit hit,
                 out float enter) {
  enter = ray.t_min;
  if (!intersect_box(ray, child.box_min, child.box_max, hit.t, enter)) return false;
  if (child.height != 0u) return true;
  test_leaf(tree, child.child, ray, sight, search, hit);
  return false;
}

void visit_pair(BinaryTree tree, TraceRay ray, Sight sight, const Search search, inout Hit hit, inout PairWalk walk) {
  Node left = load_node(tree.nodes, walk.pair), right = load_node(tree.nodes, walk.pair + 1u);
  float left_enter, right_enter;
  bool go_left = visit_child(tree, left, ray, sight, search, hit, left_enter);
  bool go_right = visit_child(tree, right, ray, sight, search, hit, right_enter);
  go_left = go_left && left_enter <= hit.t;  // the right child may have been a closer leaf
  ++walk.steps;
  if (go_left && go_right) {
    bool left_first = left_enter <= right_enter;
    stack_pair[walk.top] = left_first ? right.child : left.child;
    if (!search.any) stack_enter[walk.top] = left_first ? right_enter : left_enter;
    ++walk.top;
    walk.pair = left_first ? left.child : right.child;
  } else {
    walk.pair = go_left ? left.child : (go_right ? right.child : NO_PAIR);
  }
  if (search.any && hit.triangle != NO_TRIANGLE) {
    walk.pair = NO_PAIR;
    walk.top = 0u;
  }
}

void pop_pair(const Search search, Hit hit, inout PairWalk walk) {
  --walk.top;
  if (search.any || stack_enter[walk.top] <= hit.t) walk.pair = stack_pair[walk.top];
}

bool is_unfinished(PairWalk walk) { return walk.pair != NO_PAIR || walk.top != 0u; }

// Improves `hit`. The walk still goes on if it needs more turns than it may take.
PairWalk walk_pairs(BinaryTree tree, TraceRay ray, Sight sight, const Search search, inout Hit hit) {
  PairWalk walk = PairWalk(NO_PAIR, 0u, 0u);
  float enter;
  Node root = tree.nodes.at[0];
  if (visit_child(tree, root, ray, sight, search, hit, enter)) walk.pair = root.child;
  uint turns = 0u;
  [[dont_unroll]] while (turns < TRACE_MAX_TURNS && is_unfinished(walk)) {
    ++turns;
    [[unroll]] for (uint k = 0u; k < TRACE_VISITS; ++k) {
      if (walk.pair == NO_PAIR && walk.top != 0u) pop_pair(search, hit, walk);
      if (walk.pair != NO_PAIR) visit_pair(tree, ray, sight, search, hit, walk);
    }
  }
  return walk;
}

#endif
