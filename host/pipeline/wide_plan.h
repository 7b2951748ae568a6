#pragma once

#include "pipeline/build_plan.h"

namespace coppice {

// Where a conversion of a tree to wide nodes keeps what, beside the tree.
struct WidePlan {
  std::uint32_t levels_bound = 0;  // levels that any tree of this size, of a height that is taken, may have
  std::uint32_t dispatched_levels = 0;  // of them have dispatches of their own, if there are so many

  Slot<WideLevel> levels;
  Slot<uint> tile_sums, block_sums;

  // Scratch, a part each for every wide node.
  Slot<uint> children;
  Slot<WideEntry> entries;
  Slot<uint> sizes, offsets;
};

// The most wide nodes of a tree of `leaves` leaves; proved in docs/numerics.md.
std::uint32_t wide_nodes_bound(std::uint32_t leaves);

// Adds the wide nodes to the tree's slots, which may be those of an uploaded tree. Where a build on the
// device has left the tree its scratch is used once more, and none is added. `max_turns`: of a kernel's
// loops, fewer where a driver ends long loops by itself; there, and in large trees, no subgroup takes several
// levels. `keep`: what append_wide_boxes goes by is in Memory::update, and nothing else uses it. Throws
// LayoutError if a slot does not fit a block.
WidePlan plan_wide(Layout& layout, TreeSlots& tree, const BuildPlan* finished = nullptr,
                   std::uint32_t max_turns = 0xffffffffu, bool keep = false);

// Of a plan that keeps what refits go by, beside this build, the same without: for a tree that is not
// refitted.
WidePlan without_update(const WidePlan& plan, const BuildPlan& finished);

// The plan for a tree of fewer leaves, in the same slots. Allocates nothing.
WidePlan with_count(const WidePlan& plan, std::uint32_t leaves);

// From the binary tree its wide nodes, in depth-first order. A tree higher than WIDE_MAX_HEIGHT sets
// ERROR_WIDE_TOO_DEEP; then, and without a tree, there are none.
void append_wide(Chain& chain, const TreeSlots& tree, const WidePlan& plan);

// Behind a refit of the binary tree (refit.h): the wide nodes' boxes anew, as a conversion to wide nodes of
// the same topology leaves them. The plan's scratch still holds what append_wide left there, so no build has
// used it since.
void append_wide_boxes(Chain& chain, const TreeSlots& tree, const WidePlan& plan);

}  // namespace coppice
