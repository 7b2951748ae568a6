#include "library/state.h"
#include "stages/record_step.h"

namespace coppice {

namespace {

[[noreturn]] void fail(const char* what, const std::string& why) {
  throw ArgumentError(std::string(what) + why);
}

}  // namespace

void check_address(VkDeviceAddress address, std::uint64_t alignment, bool may_be_null, const char* what) {
  if (address == 0 && !may_be_null) fail(what, ": the address is null");
  if (address % alignment != 0) fail(what, ": the address is no multiple of " + std::to_string(alignment));
}

void check_count(const ElementCount& count, std::uint32_t maximum, const char* what) {
  if (count.maximum > maximum)
    fail(what,
         ": " + std::to_string(count.maximum) + " are more than the maximum, " + std::to_string(maximum));
  check_address(count.address, 4, true, what);
}

VkDeviceAddress checked_address(const Device& device, const MemoryRange& range, std::uint64_t bytes,
                                const char* what) {
  if (!range.buffer) fail(what, ": the buffer is null");
  if (range.bytes < bytes)
    fail(what, ": " + std::to_string(bytes) + " bytes are needed, there are " + std::to_string(range.bytes));
  const VkDeviceAddress address = device.address_of(range.buffer) + range.offset;
  check_address(address, COPPICE_MEMORY_ALIGNMENT, false, what);
  return address;
}

void CallMemory::set(Memory memory, const MemoryRange& range, std::uint64_t bytes, const char* what) {
  const auto index = static_cast<std::size_t>(memory);
  addresses_[index] = checked_address(device_, range, bytes, what);
  blocks_[index] = {range.buffer, range.offset};
  bytes_[index] = bytes;
  for (std::size_t other = 0; other < memory_kinds; ++other) {
    if (other != index && addresses_[index] < addresses_[other] + bytes_[other] &&
        addresses_[other] < addresses_[index] + bytes)
      fail(what, ": it overlaps other memory of the call");
  }
}

void CallMemory::set(Memory memory, VkDeviceAddress address, std::uint64_t bytes, std::uint64_t alignment,
                     const char* what) {
  check_address(address, alignment, bytes == 0, what);
  addresses_[static_cast<std::size_t>(memory)] = address;
}

CommandSink::CommandSink(Device& device, VkCommandBuffer commands, const Layout& layout,
                         const CallMemory& memory, KernelQueries* queries)
    : writer_(device, commands, memory.blocks()),
      hazards_(AddressMap(layout, memory.addresses()),
               queries ? Hazards::Overlap::clears : Hazards::Overlap::steps),
      queries_(queries) {
  if (queries_ && queries_->capacity > 0 && !queries_->pool) fail("queries", ": the pool is null");
  if (queries_) queries_->written = 0;
  stamp("begin");
}

CommandSink::~CommandSink() {
  if (open_) stamp(open_);
}

void CommandSink::stamp(const char* name) {
  open_ = nullptr;
  if (!queries_ || queries_->written >= queries_->capacity) return;
  writer_.stamp(queries_->pool, queries_->first + queries_->written);
  if (queries_->names) queries_->names[queries_->written] = name;
  ++queries_->written;
}

void CommandSink::take(const Step& step) {
  const StageDeclaration* const stage = stage_of(step);
  if (stage && open_) stamp(open_);
  record_step(writer_, step, hazards_);
  if (stage) {
    stamp(stage->name);
  } else if (std::holds_alternative<Clear>(step)) {
    open_ = "clear";
  }
}

void PrepareSink::take(const Step& step) {
  if (const Dispatch* const dispatch = dispatch_of(step)) prepare(device_, kernel_of(*dispatch));
}

}  // namespace coppice
