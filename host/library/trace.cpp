#include "coppice/trace.h"

#include <algorithm>

#include "interface/trace.h"
#include "library/state.h"
#include "pipeline/trace_any.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr Walk fixed_walk(TraceTree tree) {
  return tree == TraceTree::wide_packets  ? Walk::wide_packets
         : tree == TraceTree::wide_single ? Walk::wide_single
                                          : Walk::binary;
}

// What a call traces, in slots of its memory.
struct TraceCall {
  CallMemory memory;
  TreeSlots tree;
  TraceOptions options;

  TraceCall(Device& device, const TreeAddresses& addresses, const TraceOptions& options)
      : memory(device), options(options) {
    check_address(addresses.nodes, 16, false, "tree.nodes");
    check_address(addresses.state, 16, false, "tree.state");
    check_address(addresses.triangles, 4, true, "tree.triangles");
    check_address(addresses.wide_nodes, 16, true, "tree.wide_nodes");
    check_address(addresses.wide_counts, 16, true, "tree.wide_counts");
    // As many as there may be: their numbers are on the device.
    constexpr std::uint64_t most = std::uint64_t{1} << 32;
    tree.triangles = memory.slot_at<Triangle>(addresses.triangles, most);
    tree.nodes = memory.slot_at<Node>(addresses.nodes, most);
    tree.state = memory.slot_at<BuildState>(addresses.state, 1);
    tree.wide_nodes = memory.slot_at<WideNode>(addresses.wide_nodes, most);
    tree.wide_counts = memory.slot_at<WideCounts>(addresses.wide_counts, 1);
  }

  template <class T>
  Slot<T> slot(VkDeviceAddress address, std::uint64_t count, std::uint64_t alignment, const char* what) {
    check_address(address, alignment, count == 0, what);
    return memory.slot_at<T>(address, count);
  }

  RayFilter filter_of(const RayInput& rays) {
    check_count(rays.count, MAX_RAYS, "count");
    check_address(rays.primitive_flags, 4, true, "primitive_flags");
    check_address(rays.ray_masks, 4, true, "ray_masks");
    RayFilter filter;
    filter.primitive_flags = memory.slot_at<uint>(rays.primitive_flags, std::uint64_t{1} << 32);
    filter.ray_masks = memory.slot_at<uint>(rays.ray_masks, rays.count.maximum);
    filter.count_at = memory.slot_at<uint>(rays.count.address, 1);
    filter.ray_mask = rays.ray_mask;
    return filter;
  }
};

}  // namespace

static_assert(std::min(TRACE_GROUP, TRACE_PACKET) >= 64, "MAX_RAYS is what one dispatch takes");

struct Tracer::Plan {
  Plan(Device& device, TraceTree tree)
      : device(device), tree(tree), counters(layout.add<TraceCounters>("counters", 1)) {}

  std::uint64_t scratch_bytes() const { return layout.bytes_of(Memory::scratch); }

  // Throws ArgumentError where the tree does not have what is to be walked.
  TraceOptions with_walk_of(const TreeAddresses& addresses) const {
    TraceOptions with = options;
    with.walk = tree == TraceTree::automatic && addresses.wide_nodes ? Walk::wide_single : fixed_walk(tree);
    if (is_wide(with.walk) && (!addresses.wide_nodes || !addresses.wide_counts))
      throw ArgumentError("tree: it has no wide nodes");
    return with;
  }

  // All kernels of the options' walk, with and without masks.
  void prepare() const {
    for (const std::uint64_t flags : {0, 1}) {
      const Slot<uint> some{{}, flags};
      const RayFilter filter{some, {}, {}};
      prepare_chain(device, [&](Chain& chain) {
        const RaySlots rays{{{}, 1}, {{}, 1}, counters, filter};
        append_misses(chain, rays, 1);
        append_closest_hits(chain, {}, rays, 1, options);
        append_any_hits(chain, {}, {{{}, 1}, {{}, 1}, counters, filter}, 1, options);
        append_candidates(chain, {}, {1, {{}, 1}, {{}, 1}, {{}, 1}, counters, filter}, 1, options);
      });
    }
  }

  template <class Append>
  void record(VkCommandBuffer commands, TraceCall& call, const MemoryRange& scratch, KernelQueries* queries,
              Append append) const {
    call.memory.set(Memory::scratch, scratch, scratch_bytes(), "scratch");
    CommandSink sink(device, commands, layout, call.memory, queries);
    Chain chain(call.memory.addresses(), &sink);
    chain.clear(counters);
    append(chain);
  }

  Device& device;
  TraceTree tree;
  TraceOptions options;  // but for the walk
  Layout layout = Layout::apart(~std::uint64_t{0});
  Slot<TraceCounters> counters;
};

Tracer::Tracer(const Context& context, TraceTree tree) {
  Context::State& state = context.state();
  plan_ = std::make_unique<Plan>(state.device(), tree);
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    const bool walks = tree == TraceTree::automatic ? walk != Walk::wide_packets : walk == fixed_walk(tree);
    if (!walks) continue;
    plan_->options.walk = walk;
    plan_->options = state.checked(plan_->options);
    plan_->prepare();
  }
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;

VkDeviceSize Tracer::scratch_bytes() const { return plan_->scratch_bytes(); }

void Tracer::cmd_trace_closest(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                               VkDeviceAddress hits, const MemoryRange& scratch,
                               KernelQueries* queries) const {
  TraceCall call(plan_->device, tree, plan_->with_walk_of(tree));
  check_address(tree.triangles, 4, false, "tree.triangles");
  const std::uint32_t count = rays.count.maximum;
  const RaySlots slots{call.slot<Ray>(rays.rays, count, 16, "rays"), call.slot<Hit>(hits, count, 16, "hits"),
                       plan_->counters, call.filter_of(rays)};
  plan_->record(commands, call, scratch, queries, [&](Chain& chain) {
    append_misses(chain, slots, count);
    append_closest_hits(chain, call.tree, slots, count, call.options);
  });
}

void Tracer::cmd_trace_any(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                           VkDeviceAddress any_hits, const MemoryRange& scratch,
                           KernelQueries* queries) const {
  TraceCall call(plan_->device, tree, plan_->with_walk_of(tree));
  check_address(tree.triangles, 4, false, "tree.triangles");
  const std::uint32_t count = rays.count.maximum;
  const AnyHitSlots slots{call.slot<Ray>(rays.rays, count, 16, "rays"),
                          call.slot<uint>(any_hits, count, 4, "any_hits"), plan_->counters,
                          call.filter_of(rays)};
  plan_->record(commands, call, scratch, queries,
                [&](Chain& chain) { append_any_hits(chain, call.tree, slots, count, call.options); });
}

void Tracer::cmd_trace_candidates(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                                  std::uint32_t capacity, VkDeviceAddress candidates,
                                  VkDeviceAddress candidate_counts, const MemoryRange& scratch,
                                  KernelQueries* queries) const {
  TraceCall call(plan_->device, tree, plan_->options);
  const std::uint32_t count = rays.count.maximum;
  if (std::uint64_t{count} * capacity > 0xffffffffu)
    throw ArgumentError("capacity: " + std::to_string(count) + " rays of " + std::to_string(capacity) +
                        " candidates are more than 4294967295");
  const CandidateSlots slots{
      capacity,
      call.slot<Ray>(rays.rays, count, 16, "rays"),
      call.slot<BoxCandidate>(candidates, std::uint64_t{count} * capacity, 8, "candidates"),
      call.slot<uint>(candidate_counts, count, 4, "candidate_counts"),
      plan_->counters,
      call.filter_of(rays)};
  plan_->record(commands, call, scratch, queries,
                [&](Chain& chain) { append_candidates(chain, call.tree, slots, count, call.options); });
}

}  // namespace coppice
