// Exclusive prefix sums that are recorded into the caller's command buffer. Ordering and memory:
// coppice/build.h.
#pragma once

#include "coppice/context.h"

namespace coppice {

class COPPICE_API Scanner {
 public:
  // Throws ArgumentError for more than 268,435,456 words, DeviceError for a device that computes wrong.
  Scanner(const Context& context, std::uint32_t max_words);
  ~Scanner();
  Scanner(Scanner&&) noexcept;

  VkDeviceSize scratch_bytes() const;

  // For each of `count` words at `source` the sum of those before it, modulo 2^32, to `target`; both
  // addresses are multiples of 16, and their memory does not overlap. Throws ArgumentError, and records
  // nothing, as Builder::cmd_build.
  void cmd_scan(VkCommandBuffer commands, VkDeviceAddress source, VkDeviceAddress target,
                const ElementCount& count, const MemoryRange& scratch,
                KernelQueries* queries = nullptr) const;

  // As Sorter::state_address.
  VkDeviceAddress state_address(const MemoryRange& scratch) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace coppice
