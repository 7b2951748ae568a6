#pragma once

#include <cstdint>

#include "interface/batch.h"
#include "pipeline/build_plan.h"
#include "pipeline/primitives.h"

namespace coppice {

// Where a batch of small trees keeps what. A range {first, count} of the primitives, at most
// BATCH_MAX_PRIMITIVES and none in two ranges, has a tree of its own: a whole tree, the same bits as a build
// by itself of these primitives by gpu-ploc, with the same radius and bits of Morton codes. Its root is node
// 2 * first, its children's indices count from there, and its leaves' from the range's first primitive on:
// whoever walks it takes the addresses of node 2 * first and of primitive `first`, and needs to know nothing
// of batches.
struct BatchPlan {
  BuildOptions options;       // radius and morton_bits
  PrimitiveSlots primitives;  // in; their state: the primitives' number and errors, and a box about all
  Slot<BatchRange> ranges;    // in
  Slot<Node> nodes;       // out: 2 * primitives.count; of a range the first 2 * active_count - 1 of its own
  Slot<BatchTree> trees;  // out: one a range
  // Out: error bits of all trees; primitive_count is the number of ranges that was asked for.
  Slot<BuildState> state;
};

// Throws LayoutError if a slot does not fit a block, std::invalid_argument for options out of range or more
// than max_triangles.
BatchPlan plan_batch(Layout& layout, std::uint32_t primitive_count, std::uint32_t range_count,
                     const BuildOptions& options, PrimitiveKind kind = PrimitiveKind::triangles);

// `ranges_at`: null, or where the device has the number of ranges, of which at most those planned for count;
// more are ERROR_COUNT.
void append_batch(Chain& chain, const BatchPlan& plan, const BuildInput& input = {},
                  UintBuffer ranges_at = {});

}  // namespace coppice
