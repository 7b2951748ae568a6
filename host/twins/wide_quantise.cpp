#include <bit>
#include <vector>

#include "interface/wide.h"

namespace coppice::twins {

namespace {

// The grid of one axis of a node.
struct AxisGrid {
  float origin, step;

  float plane(uint q) const { return origin + static_cast<float>(q) * step; }

  // The last plane at or below the position, the first at or above it.
  uint below(float position) const {
    uint q = 255;
    while (q > 0 && plane(q) > position) --q;
    return q;
  }
  uint above(float position) const {
    uint q = 0;
    while (q < 255 && plane(q) < position) ++q;
    return q;
  }
};

uint step_exponent(float origin, float end) {
  uint exponent = WIDE_LEAST_EXPONENT;
  while (AxisGrid{origin, std::bit_cast<float>(exponent << 23)}.plane(255) < end) ++exponent;
  return exponent;
}

void set_plane(WideNode& wide, uint byte, uint q) {
  wide.planes[byte / 4] = (wide.planes[byte / 4] & ~(255u << byte % 4 * 8)) | q << byte % 4 * 8;
}

void set_box(WideNode& wide, uint child, const Node& node) {
  for (int axis = 0; axis < 3; ++axis) {
    const uint exponent = wide.exponents >> 8 * axis & 255;
    const AxisGrid grid{wide.origin[axis], std::bit_cast<float>(exponent << 23)};
    set_plane(wide, 6 * child + axis, grid.below(node.box_min[axis]));
    set_plane(wide, 6 * child + 3 + axis, grid.above(node.box_max[axis]));
  }
}

WideNode make_wide_node(const Node& root) {
  const bool is_nothing = root.box_min.x > root.box_max.x;  // NOTHING_BOX
  WideNode wide{is_nothing ? vec3(0) : root.box_min, 0, {}, {}};
  for (int axis = 0; axis < 3; ++axis)
    wide.exponents |= step_exponent(wide.origin[axis], is_nothing ? 0 : root.box_max[axis]) << 8 * axis;
  return wide;
}

}  // namespace

void wide_quantise(const WideQuantiseArgs& args) {
  const uint count = args.counts[0].node_count;
  std::vector<uint> places(count, 0);  // parents come before their children
  for (uint index = 0; index < count; ++index) {
    const WideEntry& entry = args.entries[index];
    if (index > 0) places[index] = places[entry.parent] + args.offsets[index];
    uint wide_child = entry.first_child;
    WideNode wide = make_wide_node(args.nodes[entry.root]);
    for (uint c = 0; c < WIDE_CHILDREN; ++c) {
      const uint child = args.children[std::size_t{index} * WIDE_CHILDREN + c];
      if (child == WIDE_EMPTY) {
        wide.child[c] = WIDE_EMPTY;
        for (uint axis = 0; axis < 3; ++axis) set_plane(wide, 6 * c + axis, 255);
        continue;
      }
      const bool is_leaf = child >= WIDE_LEAF;
      const Node& node = args.nodes[is_leaf ? child - WIDE_LEAF : child];
      set_box(wide, c, node);
      wide.child[c] = is_leaf ? node.child + WIDE_LEAF : places[index] + args.offsets[wide_child++];
    }
    args.wide_nodes[places[index]] = wide;
  }
}

}  // namespace coppice::twins
