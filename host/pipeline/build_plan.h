#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "coppice/build.h"
#include "interface/ploc.h"
#include "interface/types.h"
#include "interface/wide.h"
#include "pipeline/primitives.h"
#include "pipeline/variants.h"
#include "stages/chain.h"
#include "stages/layout.h"

namespace coppice {

// A builder on the device as the commands know it.
struct NamedDeviceBuilder {
  std::string_view name;
  DeviceBuilder builder;
  std::string_view cpu_builder;  // of the same tree, bit for bit
};

// All of them, the default one first.
std::span<const NamedDeviceBuilder> device_builders();

// None where the name is not that of a builder on the device.
const NamedDeviceBuilder* find_device_builder(std::string_view name);

struct BuildOptions {
  std::uint32_t radius = 16;       // search radius of PLOC and H-PLOC, 1 to PLOC_MAX_RADIUS
  std::uint32_t morton_bits = 30;  // 30 or 60
  bool lookback = true;  // false: sort and compaction by reduce, then scan: no workgroup waits for another
  // How long a tile polls its predecessor before it sums it up itself, in turns of LOOKBACK_POLLS.
  std::uint32_t lookback_turns = 16;
  std::uint32_t lookback_max_fallbacks = 64;  // a tile that would have to sum up more of them gives up
  std::uint32_t lookback_stress = 0;          // bits of interface/lookback.h, for tests
  DeviceBuilder builder = DeviceBuilder::ploc;
  Variants variants{};
};

// How the sort of a plan goes: a pure function of the number of keys and the options.
struct SortPlan {
  bool onesweep = false;  // else counting, scanning and scattering
  bool match = false;     // of Onesweep: ranks by match
  std::uint32_t digit_bits = 0;
  std::uint32_t passes_per_word = 0;
  std::uint32_t passes = 0;
  std::uint32_t tile_keys = 0, tile_count = 0;
};

// A scene's triangles and the tree over them, whoever builds it.
struct TreeSlots {
  std::uint32_t triangle_count = 0;
  Slot<Triangle> triangles;  // none of a build over boxes
  Slot<Node> nodes;          // root at 0; of a build on the device the first 2 active - 1
  Slot<BuildState> state;    // active_count is 0 without a tree

  // The same tree with wide nodes in depth-first order, root at 0. Empty slots where none is planned.
  Slot<WideNode> wide_nodes;     // wide_counts[0].node_count of them
  Slot<WideCounts> wide_counts;  // node_count is 0 without a tree
};

// Where a build keeps what. A pure function of the number of triangles and the options.
struct BuildPlan : TreeSlots {
  BuildOptions options;
  std::uint32_t rounds_bound = 0;     // rounds of PLOC that are enough for any scene of this size
  std::uint32_t recorded_rounds = 0;  // of them, those that may come before the finish

  Slot<Aabb> boxes;
  SortPlan sort;
  Slot<uint> keys[2], values[2];                    // [0] in the end: in order
  Slot<uint> unsorted_keys, unsorted_values;        // those of the slots above where the sort begins
  Slot<uint> histogram, sort_status, sort_tickets;  // of Onesweep
  Slot<uint> sort_digits;                           // else

  Slot<Node> clusters[2];  // of PLOC of even and odd rounds; H-PLOC and LBVH have one list

  // Of PLOC only.
  Slot<PlocRound> rounds;  // out: one an entered round, the last with one cluster
  Slot<uint> partners;
  Slot<uint> round_status[2];  // of even and odd rounds

  // Of H-PLOC and LBVH only.
  Slot<uint> cluster_names, arrivals;
};

// The most triangles of a build: Vulkan promises 65,535 workgroups a dispatch.
inline constexpr std::uint32_t max_triangles = 65535u * PLOC_MERGE_TILE;

LookbackConstants lookback_constants(const BuildOptions& options);

// Rounds of PLOC that reduce `clusters` clusters to at most `target`, at worst; proved in docs/numerics.md.
std::uint32_t ploc_rounds_bound(std::uint32_t clusters, std::uint32_t target);

// The plan for a build of fewer primitives, in the same slots. Allocates nothing.
BuildPlan with_count(const BuildPlan& plan, std::uint32_t primitive_count);

// For a tree of `node_count` nodes that the host uploads. Throws LayoutError if a slot does not fit a block.
TreeSlots plan_tree(Layout& layout, std::uint32_t triangle_count, std::uint64_t node_count);

// Throws std::invalid_argument for options out of range or more than max_triangles.
void check_build(std::uint32_t primitive_count, const BuildOptions& options);

// Throws LayoutError if a slot does not fit a block, and what check_build throws.
BuildPlan plan_build(Layout& layout, std::uint32_t primitive_count, const BuildOptions& options,
                     PrimitiveKind kind = PrimitiveKind::triangles);

// Only the sort's slots of a build of `key_count` pairs, or of keys alone, and its state. Throws LayoutError
// if one does not fit a block.
BuildPlan plan_sort(Layout& layout, std::uint32_t key_count, const BuildOptions& options,
                    bool has_values = true);

// Options of a sort that ends where it began: digits of 8 bits make an even number of passes.
BuildOptions sorted_in_place(BuildOptions options);

// The pairs in unsorted_keys and unsorted_values, or the keys alone, sorted stably by key, to keys[0] and
// values[0]. `count_at` as in BuildInput.
void append_sort(Chain& chain, const BuildPlan& plan, UintBuffer count_at = {});

// Primitives to tree: what brings them into the plan's slots, bounds, Morton codes, sort, and the builder of
// the options. Throws std::invalid_argument for what append_primitives does not take.
void append_build(Chain& chain, const BuildPlan& plan, const BuildInput& input = {});

}  // namespace coppice
