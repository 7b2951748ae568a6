// Which binary nodes become the children of a wide node: greedily, after Wald, Benthin and Boulos, "Getting Rid of
// Packets", 2008.
//
// It starts with the root of the wide node as the only child. As long as there are fewer than eight, the internal child
// of largest weighted half area, of equal ones the first, gives its place to its first child, and its second child is
// appended. A child that is small beside the node comes last, and is opened only where there are few children. Areas are
// normalised, so none that is denormal or infinite decides: docs/numerics.md.
#include "lib/node_words.glsl"
#include "lib/normalised.glsl"

const float NEVER_OPENED = -1.0;  // below every area
const float SMALL = -0.5;         // in the place of the area of a small child

struct Candidate {
  uint child;  // as in WideCollapseArgs::children
  uint pair;   // its first child, if it has any
  float area;
};

float normalised_area(Node node, Normalisation normalisation) {
  precise vec3 extent = normalised(node.box_max, normalisation) - normalised(node.box_min, normalisation);
  precise float area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  return area;
}

// `whole` is the area of the wide node.
Candidate candidate(uint index, Node node, float whole, Normalisation normalisation) {
  if (node.height == 0u) return Candidate(index | WIDE_LEAF, 0u, NEVER_OPENED);
  float area = normalised_area(node, normalisation);
  precise float part = area * WIDE_SMALL_PARTS;
  if (node.height > WIDE_LOW_HEIGHT) area = part < whole ? SMALL : area;
  else area *= node.height == 1u ? WIDE_HEIGHT_1_WEIGHT : WIDE_HEIGHT_2_WEIGHT;
  return Candidate(index, node.child, area);
}

// Writes the children of a new wide node. Returns how many of them are wide nodes.
uint collapse(uint entry, uint root, Normalisation normalisation) {
  Candidate candidates[WIDE_CHILDREN];
  [[unroll]] for (uint c = 0u; c < WIDE_CHILDREN; ++c) candidates[c] = Candidate(WIDE_EMPTY, 0u, NEVER_OPENED);
  Node root_node = load_node(args.nodes, root);
  float whole = normalised_area(root_node, normalisation);
  candidates[0] = candidate(root, root_node, whole, normalisation);
  [[unroll]] for (uint count = 1u; count < WIDE_CHILDREN; ++count) {
    uint opened = 0u;
    Candidate largest = candidates[0];
    [[unroll]] for (uint c = 1u; c < count; ++c) {
      if (candidates[c].area > largest.area) {
        largest = candidates[c];
        opened = c;
      }
    }
    if (largest.area > (count < WIDE_LEAST_CHILDREN ? NEVER_OPENED : SMALL)) {
      Candidate left = candidate(largest.pair, load_node(args.nodes, largest.pair), whole, normalisation);
      candidates[count] = candidate(largest.pair + 1u, load_node(args.nodes, largest.pair + 1u), whole, normalisation);
      [[unroll]] for (uint c = 0u; c < count; ++c) {
        if (c == opened) candidates[c] = left;
      }
    }
  }
  uint child_count = 0u;
  [[unroll]] for (uint c = 0u; c < WIDE_CHILDREN; ++c) {
    args.children.at[entry * WIDE_CHILDREN + c] = candidates[c].child;
    child_count += (candidates[c].child & WIDE_LEAF) == 0u ? 1u : 0u;
  }
  return child_count;
}

// A new wide node, the index-th of its level; `tile` and `block` are its level's first ones.
void enter(uint entry, uint root, uint parent, uint index, uint tile, uint block, Normalisation normalisation) {
  uint child_count = collapse(entry, root, normalisation);
  args.entries.at[entry] = WideEntry(root, parent, 0u, child_count);
  // Partners: these lines, for the other nodes of the tile and the block. Sums do not depend on their order.
  atomicAdd(args.tile_sums.at[tile + index / WIDE_TILE], child_count);
  atomicAdd(args.block_sums.at[block + index / (WIDE_TILE * WIDE_BLOCK)], child_count);
}
