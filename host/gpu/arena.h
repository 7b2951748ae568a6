#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/device.h"

namespace coppice {

// Blocks of device memory with an address, zero at the start. Copies from and to them are complete when they
// return. Where the host maps a block they wait for nothing: whoever copies knows that no submit under way
// touches what is copied.
class Arena {
 public:
  // `mapped`: of each block whether the host maps it, on every device; empty: of none. Throws DeviceError,
  // naming the size, when the device's memory is used up or the host can map no more.
  Arena(Device& device, const std::vector<std::uint64_t>& block_bytes, const std::vector<bool>& mapped = {});
  ~Arena();

  std::span<const std::uint64_t> block_addresses() const { return addresses_; }

  // Both throw DeviceError, and copy nothing, beyond the end of the block.
  void upload(std::uint32_t block, std::uint64_t offset, std::span<const std::byte> bytes);
  void download(std::uint32_t block, std::uint64_t offset, std::span<std::byte> bytes) const;

  // Where the host has mapped a block; null where it has not.
  std::byte* mapped(std::uint32_t block) const;

  // Whose bytes a block is, for copies of the caller's own.
  VkBuffer buffer(std::uint32_t block) const;

  struct Blocks;
  const Blocks& blocks() const { return *blocks_; }

 private:
  std::unique_ptr<Blocks> blocks_;
  std::vector<std::uint64_t> addresses_;
};

}  // namespace coppice
