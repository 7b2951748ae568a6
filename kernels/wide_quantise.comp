// In:  the wide tree in breadth-first order and its sizes. Out: its nodes in depth-first order, children in the order
// of their slots, boxes quantised.
// Ylitie, Karras and Laine 2017, section 3.1. Each plane is found by comparing decoded planes with the box, so that the
// decoded box contains the child's, whatever the rounding: docs/numerics.md.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = WIDE_GROUP) in;
layout(push_constant, scalar) uniform Push { WideQuantiseArgs args; };

#include "lib/node_words.glsl"
#include "lib/wide_groups.glsl"

struct Grid {
  vec3 origin, cell;
};

vec3 plane(Grid grid, vec3 q) {
  precise vec3 position = grid.origin + q * grid.cell;
  return position;
}

vec3 cells_of(uvec3 exponents) { return uintBitsToFloat(exponents << 23); }

// The smallest powers of two with which the grid reaches the other end of the box. It is one of three, see
// docs/numerics.md.
uvec3 cell_exponents(Node node) {
  precise vec3 extent = node.box_max - node.box_min;
  uvec3 exponents = max(floatBitsToUint(extent) >> 23, uvec3(WIDE_LEAST_EXPONENT + 8u)) - 8u;
  [[unroll]] for (uint larger = 0u; larger < 2u; ++larger) {
    bvec3 short_of_it = lessThan(plane(Grid(node.box_min, cells_of(exponents)), vec3(255.0)), node.box_max);
    exponents += mix(uvec3(0u), uvec3(1u), short_of_it);
  }
  return exponents;
}

// The last planes that are not above the position.
uvec3 planes_below(Grid grid, vec3 position) {
  vec3 q = vec3(0.0);
  [[unroll]] for (uint bit = 128u; bit > 0u; bit >>= 1)
    q = mix(q, q + float(bit), lessThanEqual(plane(grid, q + float(bit)), position));
  return uvec3(q);
}

// The first planes that are not below the position.
uvec3 planes_above(Grid grid, vec3 position) {
  vec3 q = vec3(0.0);
  [[unroll]] for (uint bit = 128u; bit > 0u; bit >>= 1)
    q = mix(q, q + float(bit), lessThan(plane(grid, q + float(bit - 1u)), position));
  return uvec3(q);
}

// The place in depth-first order.
uint find_place(uint entry) {
  uint place = 0u;
  [[dont_unroll]] for (uint turn = 0u; turn < WIDE_MAX_HEIGHT && entry != 0u; ++turn) {
    place += args.offsets.at[entry];
    entry = args.entries.at[entry].parent;
  }
  return place;
}

// Writes the child words. All children are read at once, as each waits for memory; their boxes come with them.
void place_children(uint index, uint place, uint wide_child) {
  uint children[WIDE_CHILDREN], words[WIDE_CHILDREN];
  [[unroll]] for (uint slot = 0u; slot < WIDE_CHILDREN; ++slot)
    children[slot] = args.children.at[index * WIDE_CHILDREN + slot];
  [[unroll]] for (uint slot = 0u; slot < WIDE_CHILDREN; ++slot) {
    bool is_node = (children[slot] & WIDE_LEAF) == 0u, is_empty = children[slot] == WIDE_EMPTY;
    uint below = args.nodes.at[is_empty ? 0u : children[slot] & ~WIDE_LEAF].child;
    words[slot] = is_node ? place + args.offsets.at[wide_child] : is_empty ? WIDE_EMPTY : WIDE_LEAF | below;
    wide_child += is_node ? 1u : 0u;
  }
  [[unroll]] for (uint slot = 0u; slot < WIDE_CHILDREN; ++slot) args.wide_nodes.at[place].child[slot] = words[slot];
}

// The planes of a child as two words: min x, y, z, max x and max y, z.
uvec2 planes_of(uint child, Grid grid) {
  uvec3 low = uvec3(255u), high = uvec3(0u);
  if (child != WIDE_EMPTY) {
    Node node = load_node(args.nodes, child & ~WIDE_LEAF);
    low = planes_below(grid, node.box_min);
    high = planes_above(grid, node.box_max);
  }
  return uvec2(low.x | low.y << 8 | low.z << 16 | high.x << 24, high.y | high.z << 8);
}

void main() {
  uint index = wide_group() * WIDE_GROUP + gl_LocalInvocationIndex;
  if (index >= args.counts.at[0].node_count) return;
  WideEntry entry = args.entries.at[index];
  uint place = find_place(index);
  place_children(index, place, entry.first_child);
  Node root = load_node(args.nodes, entry.root);
  if (root.box_min.x > root.box_max.x) root = Node(vec3(0.0), 0u, vec3(0.0), 0u);  // NOTHING_BOX: no child has a box
  uvec3 exponents = cell_exponents(root);
  Grid grid = Grid(root.box_min, cells_of(exponents));
  args.wide_nodes.at[place].origin = grid.origin;
  args.wide_nodes.at[place].exponents = exponents.x | exponents.y << 8 | exponents.z << 16;
  [[dont_unroll]] for (uint pair = 0u; pair < WIDE_CHILDREN / 2u; ++pair) {
    uint list = index * WIDE_CHILDREN + 2u * pair;
    uvec2 even = planes_of(args.children.at[list], grid), odd = planes_of(args.children.at[list + 1u], grid);
    args.wide_nodes.at[place].planes[3u * pair] = even.x;
    args.wide_nodes.at[place].planes[3u * pair + 1u] = even.y | odd.x << 16;
    args.wide_nodes.at[place].planes[3u * pair + 2u] = odd.x >> 16 | odd.y << 16;
  }
}
