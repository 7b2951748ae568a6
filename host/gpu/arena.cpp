#include "gpu/arena.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <numeric>

#include "gpu/address_space.h"
#include "gpu/arena_blocks.h"

namespace coppice {

namespace {

constexpr std::uint64_t staging_bytes = std::uint64_t{16} << 20;
constexpr std::uint64_t reserve_bytes = std::uint64_t{256} << 20;  // for the driver's kernels

[[noreturn]] void fail_for_memory(const char* whose, std::uint64_t bytes) {
  throw DeviceError(std::string("out of memory: the ") + whose + " has no " + std::to_string(bytes) +
                    " bytes left");
}

// Some drivers say success and give no address when the system maps no more.
std::byte* map(const vk::raii::DeviceMemory& memory, std::uint64_t bytes) {
  void* const address = memory.mapMemory(0, VK_WHOLE_SIZE);
  if (address == nullptr || address == reinterpret_cast<void*>(~std::uintptr_t{0}))
    fail_for_memory("host's address space", bytes);
  return static_cast<std::byte*>(address);
}

Buffer make_buffer(VulkanContext& context, std::uint64_t bytes, vk::BufferUsageFlags usage,
                   vk::MemoryPropertyFlags flags) {
  Buffer result;
  result.bytes = bytes;
  try {
    result.buffer =
        vk::raii::Buffer(context.device, {{}, bytes, usage, vk::SharingMode::eExclusive}, context.allocator);
    const auto needs = result.buffer.getMemoryRequirements();
    const bool addressed = bool(usage & vk::BufferUsageFlagBits::eShaderDeviceAddress);
    const vk::MemoryAllocateFlagsInfo address_flag(addressed ? vk::MemoryAllocateFlagBits::eDeviceAddress
                                                             : vk::MemoryAllocateFlags());
    result.memory = vk::raii::DeviceMemory(
        context.device, {needs.size, context.memory_type(needs.memoryTypeBits, flags), &address_flag},
        context.allocator);
    result.buffer.bindMemory(*result.memory, 0);
    if (addressed) result.address = context.device.getBufferAddress({*result.buffer});
    if (flags & vk::MemoryPropertyFlagBits::eHostVisible) result.mapped = map(result.memory, bytes);
  } catch (const vk::OutOfDeviceMemoryError&) {
    fail_for_memory("device", bytes);
  } catch (const vk::OutOfHostMemoryError&) {
    fail_for_memory("host", bytes);
  } catch (const vk::MemoryMapFailedError&) {
    fail_for_memory("host's address space", bytes);
  } catch (const std::bad_alloc&) {
    fail_for_memory("host", bytes);
  } catch (const vk::SystemError& error) {
    throw DeviceError("no buffer of " + std::to_string(bytes) + " bytes: " + error.what());
  }
  return result;
}

void check_range(const Buffer& block, std::uint64_t offset, std::uint64_t bytes, const char* copy) {
  if (offset <= block.bytes && bytes <= block.bytes - offset) return;
  throw DeviceError(std::string(copy) + " of " + std::to_string(bytes) + " bytes at " +
                    std::to_string(offset) + ": the block has " + std::to_string(block.bytes));
}

}  // namespace

Arena::Arena(Device& device, const std::vector<std::uint64_t>& block_bytes, const std::vector<bool>& mapped)
    : blocks_(std::make_unique<Blocks>()) {
  using Usage = vk::BufferUsageFlagBits;
  using Memory = vk::MemoryPropertyFlagBits;
  VulkanContext& context = device.context();
  blocks_->context = &context;
  const auto host = Memory::eHostVisible | Memory::eHostCoherent;
  const bool shared = context.properties.shared_memory;
  for (std::size_t block = 0; block < block_bytes.size(); ++block) {
    const std::uint64_t bytes = block_bytes[block];
    const bool maps = shared || (block < mapped.size() && mapped[block]);
    const auto usage = Usage::eStorageBuffer | Usage::eShaderDeviceAddress | Usage::eIndirectBuffer |
                       Usage::eTransferSrc | Usage::eTransferDst;
    blocks_->list.push_back(make_buffer(context, bytes, usage, maps ? host : Memory::eDeviceLocal));
    addresses_.push_back(blocks_->list.back().address);
    if (maps) std::memset(blocks_->list.back().mapped, 0, bytes);
  }
  if (context.properties.type == DeviceType::cpu)
    check_address_space(reserve_bytes, "beside " +
                                           std::to_string(std::accumulate(
                                               block_bytes.begin(), block_bytes.end(), std::uint64_t{0})) +
                                           " bytes for the device ");
  if (shared) return;
  blocks_->staging = make_buffer(context, staging_bytes, Usage::eTransferSrc | Usage::eTransferDst, host);
  run_commands(context, [&](const vk::raii::CommandBuffer& commands) {
    for (const Buffer& block : blocks_->list)
      if (!block.mapped) commands.fillBuffer(*block.buffer, 0, VK_WHOLE_SIZE, 0);
  });
}

Arena::~Arena() { free_unless_hung(*blocks_->context, blocks_); }

VkBuffer Arena::buffer(std::uint32_t block) const { return *blocks_->list.at(block).buffer; }

std::byte* Arena::mapped(std::uint32_t block) const { return blocks_->list.at(block).mapped; }

void Arena::upload(std::uint32_t block, std::uint64_t offset, std::span<const std::byte> bytes) {
  const Buffer& target = blocks_->list.at(block);
  check_range(target, offset, bytes.size(), "upload");
  if (target.mapped) {
    std::ranges::copy(bytes, target.mapped + offset);
    return;
  }
  for (std::uint64_t done = 0; done < bytes.size(); done += staging_bytes) {
    const std::uint64_t piece = std::min<std::uint64_t>(staging_bytes, bytes.size() - done);
    std::memcpy(blocks_->staging.mapped, bytes.data() + done, piece);
    run_commands(*blocks_->context, [&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(*blocks_->staging.buffer, *target.buffer, vk::BufferCopy(0, offset + done, piece));
    });
  }
}

void Arena::download(std::uint32_t block, std::uint64_t offset, std::span<std::byte> bytes) const {
  const Buffer& source = blocks_->list.at(block);
  check_range(source, offset, bytes.size(), "download");
  if (source.mapped) {
    std::copy_n(source.mapped + offset, bytes.size(), bytes.data());
    return;
  }
  for (std::uint64_t done = 0; done < bytes.size(); done += staging_bytes) {
    const std::uint64_t piece = std::min<std::uint64_t>(staging_bytes, bytes.size() - done);
    run_commands(*blocks_->context, [&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(*source.buffer, *blocks_->staging.buffer, vk::BufferCopy(offset + done, 0, piece));
    });
    std::memcpy(bytes.data() + done, blocks_->staging.mapped, piece);
  }
}

}  // namespace coppice
