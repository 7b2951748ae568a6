// Trees over triangles or boxes, built by kernels that are recorded into the caller's command buffer.
//
// Ordering. A cmd_ call begins with a memory barrier from compute shaders and transfers (their writes) to
// compute shaders, transfers and indirect commands, so calls may follow each other, share their scratch, and
// read what a compute shader or a transfer wrote before. All other stages are the caller's: where the host, a
// graphics stage or an indirect command has written an input, or has read or written what a call overwrites
// (a tree that a fragment shader walked in the frame before, say), the caller puts a barrier from there to
// COMPUTE_SHADER | ALL_TRANSFER. No barrier ends a call: before anything but another cmd_ call reads or
// overwrites what it touched, the caller puts one whose first scope is VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
// | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT with VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
// VK_ACCESS_2_TRANSFER_WRITE_BIT.
//
// Lifetimes. A builder, sorter, scanner or tracer may be destroyed when the last call is recorded; the
// context must outlive every command buffer with calls in it, as it has their pipelines.
//
// Nothing is allocated while recording, nothing is submitted, and no state but the bound compute pipeline and
// push constants of the command buffer changes.
#pragma once

#include "coppice/context.h"

namespace coppice {

// What builds the tree over the sorted Morton codes; docs/kernels.md cites the papers.
enum class DeviceBuilder { ploc, hploc, lbvh };

struct TreeOptions {
  DeviceBuilder builder = DeviceBuilder::ploc;
  std::uint32_t radius = 16;       // search radius of PLOC and H-PLOC, 1 to 100
  std::uint32_t morton_bits = 30;  // 30 or 60
  bool wide = false;               // wide nodes beside the binary ones
  bool refits = false;             // trees over triangles can be refitted when these have moved
};

struct BuildSizes {
  VkDeviceSize tree_bytes = 0;     // kept as long as the tree is used
  VkDeviceSize scratch_bytes = 0;  // free again when the build is done
  VkDeviceSize update_bytes = 0;   // kept as long as the tree is refitted; 0 without refits
};

// Indexed or plain triangles. They are copied into the tree's memory, with denormal coordinates as zero: the
// tree does not need the input any more. A triangle with a corner that is not finite, or an index beyond
// vertex_count, is not in the tree; the others keep their indices.
struct TriangleInput {
  VkDeviceAddress vertices = 0;      // three floats each; a multiple of 4
  std::uint32_t vertex_stride = 12;  // bytes, at least 12, a multiple of 4
  std::uint32_t vertex_count = 0;    // that may be read
  VkDeviceAddress indices = 0;       // three a triangle; a multiple of their size; null: 0, 1, 2, ...
  VkIndexType index_type = VK_INDEX_TYPE_UINT32;  // or UINT16
  std::uint32_t first_vertex = 0;                 // added to each index
  VkDeviceAddress transform = 0;  // 12 floats, three rows of a 3 x 4 matrix; a multiple of 4; null: none
  ElementCount count{};           // triangles
};

// Boxes of primitives that only the caller knows: CoppiceBox each. One that is not finite, or has box_min >
// box_max, is not in the tree. Rays find their candidates by cmd_trace_candidates.
struct BoxInput {
  VkDeviceAddress boxes = 0;  // a multiple of 4
  std::uint32_t stride = 24;  // bytes, at least 24, a multiple of 4
  ElementCount count{};
};

// Where a tree lies, for traces and for the caller's own shaders.
struct TreeAddresses {
  VkDeviceAddress nodes = 0;        // CoppiceNode; root at 0
  VkDeviceAddress state = 0;        // CoppiceTreeState: the flag word, and whether there is a tree
  VkDeviceAddress triangles = 0;    // CoppiceTriangle, by their indices; null for boxes
  VkDeviceAddress wide_nodes = 0;   // CoppiceWideNode; root at 0; null without them
  VkDeviceAddress wide_counts = 0;  // their number is the first word; null without them
  VkDeviceAddress refit_state = 0;  // CoppiceRefitState of the last refit; null without refits
};

// Builds of up to so many primitives, any number of them; one can be used by several threads at once. The
// same input and options give the same bits on every device.
class COPPICE_API Builder {
 public:
  // Compiles the kernels that are not yet compiled, and lets the device be checked. Throws ArgumentError for
  // options out of range or more primitives than a build takes (67,107,840), DeviceError for a device that
  // computes wrong.
  Builder(const Context& context, std::uint32_t max_primitives, const TreeOptions& options = {});
  ~Builder();
  Builder(Builder&&) noexcept;

  BuildSizes sizes() const;

  // The tree's memory and the scratch are overwritten. Throw ArgumentError, and record nothing, where the
  // count is larger than max_primitives, memory is too small or misaligned, tree and scratch overlap, or
  // queries have no pool. `scratch` may be shared with other calls of the same command buffer.
  void cmd_build(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                 const MemoryRange& scratch, KernelQueries* queries = nullptr) const;
  void cmd_build(VkCommandBuffer commands, const BoxInput& input, const MemoryRange& tree,
                 const MemoryRange& scratch, KernelQueries* queries = nullptr) const;

  // The same of a builder with `refits`, for a tree that will be refitted: `update`, which must be free of
  // tree and scratch, too, is written and belongs to the tree. (The other calls build trees that will not.)
  void cmd_build(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                 const MemoryRange& scratch, const MemoryRange& update,
                 KernelQueries* queries = nullptr) const;

  // Gives all nodes of the tree, wide ones too, the boxes of the triangles as `input` has them now, whose
  // order and number are those of the build. The topology stays: the more the triangles have moved among each
  // other, the slower are traces. A triangle that is no longer finite vanishes, and may come back; one that
  // was not when the tree was built is missed, and counted in CoppiceRefitState::appeared_count. Needs no
  // scratch. Throws ArgumentError as cmd_build, and without `refits`.
  void cmd_refit(VkCommandBuffer commands, const TriangleInput& input, const MemoryRange& tree,
                 const MemoryRange& update, KernelQueries* queries = nullptr) const;

  // The sums of CoppiceRefitState by which the SAH cost of the tree is known, the same bits on every device:
  // behind a build with `update`, or a refit (which clears them). `maximum` is the count's of the build.
  void cmd_tree_cost(VkCommandBuffer commands, std::uint32_t maximum, const MemoryRange& tree,
                     const MemoryRange& update, KernelQueries* queries = nullptr) const;

  // Of a tree that has been, or will be, built into this memory. Throws ArgumentError as cmd_build.
  TreeAddresses triangle_tree(const MemoryRange& tree) const;
  TreeAddresses box_tree(const MemoryRange& tree) const;

  struct Plan;  // the library's own

 private:
  std::unique_ptr<Plan> plan_;
};

// Where the trees of a batch lie.
struct BatchAddresses {
  VkDeviceAddress nodes = 0;      // CoppiceNode; the tree of a range from 2 * first on, its root first: its
                                  // children count from there, its leaves from the range's first primitive
  VkDeviceAddress trees = 0;      // CoppiceBatchTree, one a range
  VkDeviceAddress triangles = 0;  // CoppiceTriangle, all of them; null for boxes
  VkDeviceAddress state = 0;  // CoppiceTreeState: error_word has the bits of all trees, primitive_count is
                              // the number of ranges
  VkDeviceAddress input_state = 0;  // CoppiceTreeState of the primitives: whether there were too many, of
                                    // which those beyond the maximum are in no tree
};

// Many small trees in one go: a dispatch for all. Each has at most COPPICE_BATCH_MAX_PRIMITIVES primitives
// and is the same, bit for bit, as one that a Builder by PLOC makes of them alone. Otherwise as a Builder.
class COPPICE_API BatchBuilder {
 public:
  // Of the options the radius and the Morton bits count.
  BatchBuilder(const Context& context, std::uint32_t max_primitives, std::uint32_t max_trees,
               const TreeOptions& options = {});
  ~BatchBuilder();
  BatchBuilder(BatchBuilder&&) noexcept;

  BuildSizes sizes() const;

  // `ranges`: CoppiceRange each, a multiple of 8; no primitive is in two of them. A range that is too large,
  // or reaches beyond the primitives, has no tree and sets COPPICE_ERROR_BATCH_RANGE.
  void cmd_build(VkCommandBuffer commands, const TriangleInput& input, VkDeviceAddress ranges,
                 const ElementCount& range_count, const MemoryRange& tree, const MemoryRange& scratch,
                 KernelQueries* queries = nullptr) const;
  void cmd_build(VkCommandBuffer commands, const BoxInput& input, VkDeviceAddress ranges,
                 const ElementCount& range_count, const MemoryRange& tree, const MemoryRange& scratch,
                 KernelQueries* queries = nullptr) const;

  BatchAddresses triangle_trees(const MemoryRange& tree) const;
  BatchAddresses box_trees(const MemoryRange& tree) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

// At least what a Builder of these says; compiles and checks nothing. Throws ArgumentError as a Builder.
COPPICE_API BuildSizes build_sizes(const Context& context, std::uint32_t max_primitives,
                                   const TreeOptions& options = {});

}  // namespace coppice
