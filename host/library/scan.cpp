#include "coppice/scan.h"

#include "library/state.h"
#include "pipeline/scan_plan.h"

namespace coppice {

struct Scanner::Plan {
  Device& device;
  Layout layout;
  ScanPlan scan;
};

Scanner::Scanner(const Context& context, std::uint32_t max_words) {
  const BuildOptions checked = context.state().checked({.builds = false, .scans = true});
  Layout layout = Layout::apart(~std::uint64_t{0});
  const ScanPlan plan = with_argument_errors([&] { return plan_scan(layout, max_words, checked); });
  plan_ = std::make_unique<Plan>(Plan{context.state().device(), std::move(layout), plan});
  prepare_chain(plan_->device, [&](Chain& chain) { append_scan(chain, plan); });
}

Scanner::~Scanner() = default;
Scanner::Scanner(Scanner&&) noexcept = default;

VkDeviceSize Scanner::scratch_bytes() const { return plan_->layout.bytes_of(Memory::scratch); }

VkDeviceAddress Scanner::state_address(const MemoryRange& scratch) const {
  return checked_address(plan_->device, scratch, scratch_bytes(), "scratch") + plan_->scan.state.place.offset;
}

void Scanner::cmd_scan(VkCommandBuffer commands, VkDeviceAddress source, VkDeviceAddress target,
                       const ElementCount& count, const MemoryRange& scratch, KernelQueries* queries) const {
  check_count(count, plan_->scan.word_count, "count");
  CallMemory memory(plan_->device);
  memory.set(Memory::scratch, scratch, scratch_bytes(), "scratch");
  memory.set(Memory::source, source, std::uint64_t{count.maximum} * 4, 16, "source");
  memory.set(Memory::target, target, std::uint64_t{count.maximum} * 4, 16, "target");
  CommandSink sink(plan_->device, commands, plan_->layout, memory, queries);
  Chain chain(memory.addresses(), &sink);
  ScanPlan plan = plan_->scan;
  plan.word_count = count.maximum;
  chain.clear(plan.state);
  append_scan(chain, plan, {count.address});
}

}  // namespace coppice
