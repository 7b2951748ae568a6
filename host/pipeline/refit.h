#pragma once

#include "interface/refit.h"
#include "pipeline/build_plan.h"

namespace coppice {

// Where refits of a tree keep what, beside the tree. See docs/pipeline.md.
struct RefitPlan {
  std::uint32_t dispatched_levels = 0;  // have dispatches of their own
  Slot<RefitState> state;               // of the last refit

  // Kept from append_refit_order on as long as the tree is refitted.
  Slot<uint> order;  // inner nodes by ascending key
  Slot<RefitLevel> levels;
  Slot<uint> absent;      // a bit for each triangle that has no leaf; as good as empty where all have one
  Slot<uint> pair_count;  // inner nodes

  // Scratch.
  Slot<uint> keys[2], parents;  // keys[1] in order
  Slot<uint> tile_digits;
  std::uint32_t tile_keys = 0;
  Slot<BuildState> sort_state;
  Slot<float> tile_areas;
};

// What refits need beside a tree, whose slots may be those of an uploaded one. Where a build on the device
// leaves the tree, its keys and values are used once more: then every build needs a new append_refit_order
// behind it. `max_turns` as for plan_wide. `keep`: what lives as long as the tree is refitted is in
// Memory::update, and nothing else uses it. Throws LayoutError if a slot does not fit a block.
RefitPlan plan_refit(Layout& layout, const TreeSlots& tree, const BuildPlan* finished = nullptr,
                     std::uint32_t max_turns = 0xffffffffu, bool keep = false);

// The plan for a tree of fewer leaves, in the same slots. Allocates nothing.
RefitPlan with_count(const RefitPlan& plan, std::uint32_t leaves);

// Behind a build, and before what moves its triangles: the order in which refits go, and which triangles have
// no leaf. Needed once a build. The two children of a node stand at an odd place and the one behind it, as
// all builders here leave them. A tree higher than REFIT_MAX_HEIGHT sets ERROR_REFIT_TOO_DEEP, and is left as
// it is by refits.
void append_refit_order(Chain& chain, const TreeSlots& tree, const RefitPlan& plan);

// Gives all nodes of the tree the boxes of tree.triangles as they lie now; `child` and `height` stay as they
// are. Right behind a build the boxes keep their bits. A triangle that has a corner that is not finite keeps
// its leaf, with the box NOTHING_BOX that no ray hits, and may come back. One that had no leaf from the
// beginning and is finite now is in no box: RefitState::appeared_count says how many there are, and the
// frame's tree is to be built anew. Clears the RefitState before. A wide tree
// goes on with append_wide_boxes (wide_plan.h).
void append_refit(Chain& chain, const TreeSlots& tree, const RefitPlan& plan);

// Behind a build or a refit: area_sum and root_area of the RefitState, in the same bits on every device.
void append_tree_cost(Chain& chain, const TreeSlots& tree, const RefitPlan& plan);

// The SAH cost (see TreeQuality) that append_tree_cost left, of a tree of so many leaves; 0 of an empty one.
double sah_cost(const RefitState& state, std::uint32_t leaves);

// How far it may be from the exact one, as a part of that: 2^-24 for each of the sums and products that
// follow each other. Coordinates smaller than 2^-99 of the largest one count as 0.
double sah_cost_error(std::uint32_t leaves);

}  // namespace coppice
