#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coppice/context.h"

// Of what goes wrong in this folder no exceptions leave it but DeviceError and std::bad_alloc.
namespace coppice {

enum class DeviceType { discrete, integrated, virtual_gpu, cpu, other };
const char* to_string(DeviceType type);

struct DeviceListing {
  std::uint32_t index;
  std::string name;
  std::string driver;  // name and version, as the driver says them
  DeviceType type;
  std::string unsuitable_because;  // empty for a device that can be used
};

// All devices of the machine, suitable or not, in the loader's order. Empty without a Vulkan loader or
// driver.
std::vector<DeviceListing> list_devices();

// No device's name or index is as DeviceOptions::select says.
struct NoSuchDevice : DeviceError {
  using DeviceError::DeviceError;
};

struct DeviceOptions {
  std::string select;     // part of a name or an index; empty: discrete before integrated before CPU
  bool validate = false;  // validation layers, synchronization validation included
  // Nothing that only CPU devices allow, for tests: copies go through staging buffers, and the invocations of
  // a subgroup wait for each other.
  bool like_a_gpu = false;
  std::filesystem::path pipeline_folder{};  // compiled pipelines are kept here between runs; empty: nowhere
  // Off: as a device without timestamps, for tests.
  bool timestamps = true;
  Log log{};
};

struct DeviceProperties {
  std::string name;
  std::string driver;
  DeviceType type;
  std::uint32_t subgroup_size;
  bool has_subgroup_sizes;        // to choose from, for each kernel
  std::uint64_t max_block_bytes;  // largest single allocation
  std::uint64_t memory_bytes;     // of its own memory in all: the largest of its heaps
  double timestamp_period_ns;     // 0: no timestamps
  bool shared_memory;             // the host maps the device's memory
  bool lanes_in_step;             // the invocations of a subgroup are the lanes of one vector
  // Old lavapipe silently ends the loops of an invocation after 65,535 turns in all; 0: no limit known.
  std::uint32_t loop_turn_limit;
  // Turns that are left to loops with a bound of their own.
  std::uint32_t max_turns() const { return loop_turn_limit == 0 ? 0xffffffffu : loop_turn_limit - 1000; }
};

// Where programs keep what they can make again: $XDG_CACHE_HOME/coppice, or .cache/coppice in $HOME; empty
// where neither is set.
std::filesystem::path cache_folder();

struct VulkanContext;  // gpu/vulkan_context.h, only for this folder

class Device {
 public:
  // Throws DeviceError if there is no such device, or it lacks what the kernels need.
  explicit Device(const DeviceOptions& options = {});
  // The caller's device, as it is documented there; compiled pipelines are kept in the folder, as above,
  // unless there is a cache of the caller's.
  Device(const AdoptedDevice& device, std::filesystem::path pipeline_folder, Log log);
  ~Device();
  Device(Device&&) noexcept;

  const DeviceProperties& properties() const;

  // What the validation layers said since the last call.
  std::vector<std::string> take_validation_messages();

  // Whether the pipelines of an earlier run are at hand; false where none are kept.
  bool has_kept_pipelines() const;

  // A file beside the pipelines for what else is kept of this device and driver; empty where nothing is kept.
  std::filesystem::path kept_file(std::string_view stem) const;

  VkInstance instance() const;
  VkPhysicalDevice physical_device() const;
  VkDevice device() const;
  VkQueue queue() const;  // null where none was given
  std::uint32_t queue_family() const;
  std::uint64_t address_of(VkBuffer buffer) const;

  // One line to the log, if there is one.
  void say(const std::string& line) const;

  VulkanContext& context() const { return *context_; }

 private:
  std::unique_ptr<VulkanContext> context_;
};

}  // namespace coppice
