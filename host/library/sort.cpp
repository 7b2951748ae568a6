#include "coppice/sort.h"

#include "interface/sort.h"
#include "library/state.h"
#include "pipeline/build_plan.h"

namespace coppice {

struct Sorter::Plan {
  Device& device;
  Layout layout;
  BuildPlan sort;
};

Sorter::Sorter(const Context& context, std::uint32_t max_keys, const SortOptions& options) {
  if (options.key_words != 1 && options.key_words != 2)
    throw ArgumentError("key_words: 1 or 2, not " + std::to_string(options.key_words));
  if (max_keys > max_triangles)
    throw ArgumentError("max_keys: " + std::to_string(max_keys) + " are more than a sort takes, " +
                        std::to_string(max_triangles));
  BuildOptions wanted;
  wanted.morton_bits = options.key_words * 30;
  const BuildOptions checked = sorted_in_place(context.state().checked(
      {.builds = false, .build = wanted, .sorts = true, .sorts_values = options.values}));
  Layout layout = Layout::apart(~std::uint64_t{0});
  const BuildPlan plan = plan_sort(layout, max_keys, checked, options.values);
  plan_ = std::make_unique<Plan>(Plan{context.state().device(), std::move(layout), plan});
  prepare_chain(plan_->device, [&](Chain& chain) {
    append_sort(chain, with_count(plan, max_keys));
    append_sort(chain, with_count(plan, std::min(max_keys, SORT_SCAN_TILE)));
  });
}

Sorter::~Sorter() = default;
Sorter::Sorter(Sorter&&) noexcept = default;

VkDeviceSize Sorter::scratch_bytes() const { return plan_->layout.bytes_of(Memory::scratch); }

VkDeviceAddress Sorter::state_address(const MemoryRange& scratch) const {
  return checked_address(plan_->device, scratch, scratch_bytes(), "scratch") + plan_->sort.state.place.offset;
}

void Sorter::cmd_sort(VkCommandBuffer commands, VkDeviceAddress keys, VkDeviceAddress values,
                      const ElementCount& count, const MemoryRange& scratch, KernelQueries* queries) const {
  check_count(count, plan_->sort.triangle_count, "count");
  if (values != 0 && plan_->sort.values[0].count == 0)
    throw ArgumentError("values: this sorter sorts keys alone");
  CallMemory memory(plan_->device);
  memory.set(Memory::scratch, scratch, scratch_bytes(), "scratch");
  memory.set(Memory::keys, keys, plan_->sort.keys[0].bytes(), 16, "keys");
  memory.set(Memory::values, values, plan_->sort.values[0].bytes(), 16, "values");
  CommandSink sink(plan_->device, commands, plan_->layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  const BuildPlan plan = with_count(plan_->sort, count.maximum);
  chain.clear(plan.state);
  append_sort(chain, plan, {count.address});
}

}  // namespace coppice
