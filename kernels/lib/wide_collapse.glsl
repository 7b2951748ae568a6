// Which binary nodes become the children of a wide node: greedily, after Wald, Benthin and Boulos, "Getting Rid of
// Packets", 2008.
//
// It starts with the root of the wide node as the only child. As long as there are fewer than eight, the internal child
// of largest weighted half area, of equal ones the first, gives its place to its first child, and its second child is
// appended. A child that is small beside the node comes last, and is opened only where there are few children. Areas are
// normalised, so none that is denormal or infinite decides: docs/numerics.md.
#include "lib/node_words.glsl"
#include "lib/normalised.glsl"

// Lists of children; the including kernel says whether it reads what it has written itself.
layout(buffer_reference, scalar, buffer_reference_align = 16) WIDE_COHERENT buffer ChildListBuffer {
  u64vec4 at[];
};

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

Candidate candidates[WIDE_CHILDREN];

// Opens the largest of `count` candidates, a constant, so that all indices are.
void open_largest(const uint count, float whole, Normalisation normalisation) {
  uint opened = 0u, pair = candidates[0].pair;
  float largest = candidates[0].area;
  [[unroll]] for (uint c = 1u; c < count; ++c) {
    bool larger = candidates[c].area > largest;
    largest = larger ? candidates[c].area : largest;
    pair = larger ? candidates[c].pair : pair;
    opened = larger ? c : opened;
  }
  if (largest > (count < WIDE_LEAST_CHILDREN ? NEVER_OPENED : SMALL)) {
    Candidate left = candidate(pair, load_node(args.nodes, pair), whole, normalisation);
    candidates[count] = candidate(pair + 1u, load_node(args.nodes, pair + 1u), whole, normalisation);
    [[unroll]] for (uint c = 0u; c < count; ++c) {
      if (c == opened) candidates[c] = left;
    }
  }
}

// Writes the children of a new wide node. Returns how many of them are wide nodes.
uint collapse(uint entry, uint root, Normalisation normalisation) {
  [[unroll]] for (uint c = 0u; c < WIDE_CHILDREN; ++c) candidates[c] = Candidate(WIDE_EMPTY, 0u, NEVER_OPENED);
  Node root_node = load_node(args.nodes, root);
  float whole = normalised_area(root_node, normalisation);
  candidates[0] = candidate(root, root_node, whole, normalisation);
  open_largest(1u, whole, normalisation);
  open_largest(2u, whole, normalisation);
  open_largest(3u, whole, normalisation);
  open_largest(4u, whole, normalisation);
  open_largest(5u, whole, normalisation);
  open_largest(6u, whole, normalisation);
  open_largest(7u, whole, normalisation);
  u64vec4 pairs;
  uint child_count = 0u;
  [[unroll]] for (uint c = 0u; c < WIDE_CHILDREN; c += 2u) {
    uint even = candidates[c].child, odd = candidates[c + 1u].child;
    pairs[c / 2u] = packUint2x32(uvec2(even, odd));
    child_count += 2u - (even >> 31) - (odd >> 31);
  }
  ChildListBuffer(args.children).at[entry] = pairs;
  return child_count;
}

// A new wide node. Returns how many of its children are wide nodes.
uint enter(uint entry, uint root, uint parent, Normalisation normalisation) {
  uint child_count = collapse(entry, root, normalisation);
  args.entries.at[entry] = WideEntry(root, parent, 0u, child_count);
  return child_count;
}
