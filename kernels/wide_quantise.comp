// In:  the wide tree in breadth-first order and its sizes. Out: its nodes in depth-first order, children in the order
// of their slots, boxes quantised.
// Ylitie, Karras and Laine 2017, section 3.1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/wide.h"

layout(local_size_x = WIDE_GROUP) in;
layout(push_constant, scalar) uniform Push { WideQuantiseArgs args; };

#include "lib/node_words.glsl"
#include "lib/wide_groups.glsl"
#include "lib/wide_planes.glsl"

// The place in depth-first order.
uint find_place(uint entry) {
  uint place = 0u;
  [[dont_unroll]] for (uint turn = 0u; turn < WIDE_MAX_HEIGHT && entry != 0u; ++turn) {
    place += args.offsets.at[entry];
    entry = args.entries.at[entry].parent;
  }
  return place;
}

uint children[WIDE_CHILDREN];

void load_children(uint index) {
  u64vec4 words = NodeWordsBuffer(args.children).at[index];
  [[unroll]] for (uint pair = 0u; pair < WIDE_CHILDREN / 2u; ++pair) {
    uvec2 both = unpackUint2x32(words[pair]);
    children[2u * pair] = both.x;
    children[2u * pair + 1u] = both.y;
  }
}

// Writes the child words. All children are read at once, as each waits for memory; their boxes come with them.
void place_children(uint place, uint wide_child) {
  uint words[WIDE_CHILDREN];
  [[unroll]] for (uint slot = 0u; slot < WIDE_CHILDREN; ++slot) {
    bool is_node = (children[slot] & WIDE_LEAF) == 0u, is_empty = children[slot] == WIDE_EMPTY;
    uint below = args.nodes.at[is_empty ? 0u : children[slot] & ~WIDE_LEAF].child;
    words[slot] = is_node ? place + args.offsets.at[wide_child] : is_empty ? WIDE_EMPTY : WIDE_LEAF | below;
    wide_child += is_node ? 1u : 0u;
  }
  u64vec4 pairs;
  [[unroll]] for (uint pair = 0u; pair < WIDE_CHILDREN / 2u; ++pair)
    pairs[pair] = packUint2x32(uvec2(words[2u * pair], words[2u * pair + 1u]));
  NodeWordsBuffer(args.wide_nodes).at[3u * place + 2u] = pairs;
}

uvec2 child_planes(uint child, Grid grid) {
  Node node = load_node(args.nodes, child == WIDE_EMPTY ? 0u : child & ~WIDE_LEAF);
  uvec2 planes = planes_of(grid, node.box_min, node.box_max);
  return child == WIDE_EMPTY ? EMPTY_PLANES : planes;
}

void main() {
  uint index = wide_group() * WIDE_GROUP + gl_LocalInvocationIndex;
  if (index >= args.counts.at[0].node_count) return;
  WideEntry entry = args.entries.at[index];
  uint place = find_place(index);
  load_children(index);
  place_children(place, entry.first_child);
  Node root = load_node(args.nodes, entry.root);
  if (root.box_min.x > root.box_max.x) root = Node(vec3(0.0), 0u, vec3(0.0), 0u);  // NOTHING_BOX: no child has a box
  uvec3 exponents = cell_exponents(root);
  Grid grid = grid_of(root.box_min, exponents);
  uint words[4 + WIDE_PLANE_WORDS];
  [[unroll]] for (uint axis = 0u; axis < 3u; ++axis) words[axis] = floatBitsToUint(grid.origin[axis]);
  words[3] = exponents.x | exponents.y << 8 | exponents.z << 16;
  [[unroll]] for (uint pair = 0u; pair < WIDE_CHILDREN / 2u; ++pair) {
    uvec2 even = child_planes(children[2u * pair], grid), odd = child_planes(children[2u * pair + 1u], grid);
    words[4u + 3u * pair] = even.x;
    words[5u + 3u * pair] = even.y | odd.x << 16;
    words[6u + 3u * pair] = odd.x >> 16 | odd.y << 16;
  }
  [[unroll]] for (uint row = 0u; row < 2u; ++row) {
    u64vec4 pairs;
    [[unroll]] for (uint pair = 0u; pair < 4u; ++pair)
      pairs[pair] = packUint2x32(uvec2(words[8u * row + 2u * pair], words[8u * row + 2u * pair + 1u]));
    NodeWordsBuffer(args.wide_nodes).at[3u * place + row] = pairs;
  }
}
