// Leaves of triangles in Morton order. Their boxes lie anywhere in memory, so an invocation has several on their way at
// a time. The including kernel has `args` with values and boxes.
#include "lib/node_words.glsl"
#include "lib/subgroup.glsl"

const uint LEAVES_AHEAD = 4u;

// Of the places first, first + LANES, ...; those from `last` on repeat the one before it.
void load_leaves(uint first, uint last, out Node leaves[LEAVES_AHEAD]) {
  uint triangles[LEAVES_AHEAD];
  [[unroll]] for (uint k = 0u; k < LEAVES_AHEAD; ++k) triangles[k] = args.values.at[min(first + k * LANES, last - 1u)];
  [[unroll]] for (uint k = 0u; k < LEAVES_AHEAD; ++k) {
    Aabb box = load_box(args.boxes, triangles[k]);
    leaves[k] = Node(box.box_min, triangles[k], box.box_max, 0u);
  }
}
