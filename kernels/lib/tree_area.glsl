// Half areas of nodes in normalised coordinates of the root's box, times 2^-32 so that no sum of them overflows; and sums
// of a workgroup in an order of their own, which no size of a subgroup changes.
#include "lib/node_words.glsl"
#include "lib/normalised.glsl"

shared float sums[TREE_AREAS_GROUP];

Normalisation tree_normalisation() {
  Node root = args.nodes.at[0];
  bool is_nothing = root.box_min.x > root.box_max.x;
  return normalisation_of(is_nothing ? vec3(0.0) : root.box_min, is_nothing ? vec3(0.0) : root.box_max);
}

float half_area(Node node, Normalisation normalisation) {
  if (node.box_min.x > node.box_max.x) return 0.0;  // of no active triangle
  precise vec3 extent = normalised(node.box_max, normalisation) - normalised(node.box_min, normalisation);
  precise float area = (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x) * TREE_AREAS_SCALE;
  return area;
}

float sum_of(float a, float b) {
  precise float sum = a + b;
  return sum;
}

// Of all invocations: the upper half is added to the lower one, and so on. Only invocation 0 is given it.
float group_sum(float part) {
  uint i = gl_LocalInvocationIndex;
  sums[i] = part;
  barrier();
  [[dont_unroll]] for (uint half_count = TREE_AREAS_GROUP / 2u; half_count > 0u; half_count >>= 1) {
    if (i < half_count) sums[i] = sum_of(sums[i], sums[i + half_count]);
    barrier();
  }
  return sums[0];
}

uint tree_nodes() {
  uint active_count = args.state.at[0].active_count;
  return active_count == 0u ? 0u : 2u * active_count - 1u;
}
