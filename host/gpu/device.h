#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

// Whatever goes wrong with a device, in one line; no other exception leaves this folder but std::bad_alloc.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

struct DeviceOptions {
  std::string select;     // part of a name or an index; empty: discrete before integrated before CPU
  bool validate = false;  // validation layers, synchronization validation included
  // Nothing that only CPU devices allow, for tests: copies go through staging buffers, and the invocations of
  // a subgroup wait for each other.
  bool like_a_gpu = false;
  std::filesystem::path pipeline_folder{};  // compiled pipelines are kept here between runs; empty: nowhere
  // Off: as a device without timestamps, for tests. Off, too, where COPPICE_NO_TIMESTAMPS is set and not
  // empty.
  bool timestamps = true;
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
};

// Where programs keep what they can make again: $XDG_CACHE_HOME/coppice, or .cache/coppice in $HOME; empty
// where neither is set.
std::filesystem::path cache_folder();

struct VulkanContext;  // gpu/vulkan_context.h, only for this folder

class Device {
 public:
  // Throws DeviceError if there is no such device, or it lacks what the kernels need.
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;

  const DeviceProperties& properties() const;

  // What the validation layers said since the last call.
  std::vector<std::string> take_validation_messages();

  // Whether the pipelines of an earlier run are at hand; false where none are kept.
  bool has_kept_pipelines() const;

  // A file beside the pipelines for what else is kept of this device and driver; empty where nothing is kept.
  std::filesystem::path kept_file(std::string_view stem) const;

  VulkanContext& context() { return *context_; }

 private:
  std::unique_ptr<VulkanContext> context_;
};

}  // namespace coppice
