// A stable radix sort that is recorded into the caller's command buffer. Ordering and memory:
// coppice/build.h.
#pragma once

#include "coppice/context.h"

namespace coppice {

struct SortOptions {
  std::uint32_t key_words = 1;  // 1, or 2: 60 bits, the low word first
  bool values = true;           // false: keys alone
};

class COPPICE_API Sorter {
 public:
  // Throws ArgumentError for options out of range or more than 67,107,840 keys, DeviceError for a device that
  // computes wrong.
  Sorter(const Context& context, std::uint32_t max_keys, const SortOptions& options = {});
  ~Sorter();
  Sorter(Sorter&&) noexcept;

  VkDeviceSize scratch_bytes() const;

  // Sorts `count` keys, and values with them, in place: at `keys` key_words words each, at `values` one (null
  // for keys alone); both addresses are multiples of 16, and max_keys of them may be written. What lies
  // behind the count stays as it is. Throws ArgumentError, and records nothing, as Builder::cmd_build.
  void cmd_sort(VkCommandBuffer commands, VkDeviceAddress keys, VkDeviceAddress values,
                const ElementCount& count, const MemoryRange& scratch,
                KernelQueries* queries = nullptr) const;

  // Where in the scratch a sort leaves a CoppiceTreeState, of which error_word and primitive_count are its
  // own.
  VkDeviceAddress state_address(const MemoryRange& scratch) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace coppice
