// A Vulkan device as Coppice uses it: the caller's, or one of its own.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "coppice/types.h"

namespace coppice {

// Whatever the library throws, but for std::bad_alloc, in one line.
struct COPPICE_API Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What goes wrong with a device: there is none, it lacks something (which is named), it has no memory left,
// or it computes wrong.
struct COPPICE_API DeviceError : Error {
  using Error::Error;
};

// The device did not finish in time. What it works on is left alone for good: nothing of it is freed.
struct COPPICE_API DeviceHung : DeviceError {
  using DeviceError::DeviceError;
};

// The device is gone, as after a reset of the driver: all that was made of it can only be freed.
struct COPPICE_API DeviceLost : DeviceError {
  using DeviceError::DeviceError;
};

// A call whose arguments cannot be: memory too small or misaligned, a count beyond its maximum, an option out
// of its range. Nothing has been recorded.
struct COPPICE_API ArgumentError : Error {
  using Error::Error;
};

// Takes a line without its end.
using Log = std::function<void(std::string_view line)>;

struct ContextOptions {
  // Of a device of its own: part of its name, or its index; empty: the most capable kind.
  std::string select{};
  bool validate = false;  // of a device of its own: validation layers, synchronization validation included
  // Compiled pipelines and the verdicts of self-checks are kept here between runs, by driver; empty: nowhere.
  std::filesystem::path cache_folder{};
  Log log{};
};

// A device that the caller has made. All handles must outlive the context.
struct AdoptedDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  // of the command buffers that are recorded into; it can compute
  // The chain that the device was made with: VkPhysicalDeviceFeatures2 with the structures of Vulkan 1.2
  // and 1.3 behind it. What is needed and not enabled is refused by name.
  const VkPhysicalDeviceFeatures2* enabled_features = nullptr;
  // For the self-check, which submits while a context's objects are constructed, and then only: no other
  // thread may use the queue meanwhile. Null: no check is made, and what it would have to allow is not used.
  VkQueue queue = VK_NULL_HANDLE;
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;             // null: one in the cache folder, or none
  const VkAllocationCallbacks* allocator = nullptr;            // for all objects that the context makes
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // null: that of the system's loader
};

// What a device must have, to be asked and enabled before it is made. No extensions are needed beside
// Vulkan 1.3.
struct COPPICE_API RequiredFeatures {
  RequiredFeatures();  // as Coppice needs them, and no others
  RequiredFeatures(const RequiredFeatures&) = delete;
  RequiredFeatures& operator=(const RequiredFeatures&) = delete;

  VkPhysicalDeviceFeatures2 features{};  // the head of the chain, for VkDeviceCreateInfo::pNext
  VkPhysicalDeviceVulkan12Features vulkan12{};
  VkPhysicalDeviceVulkan13Features vulkan13{};  // the end of the chain
};

// Why a physical device cannot be used, by the feature, limit or version that it lacks; empty if it can.
COPPICE_API std::string why_unsuitable(VkInstance instance, VkPhysicalDevice physical_device,
                                       PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr);

// What of them is not enabled in a chain of features, by name; empty if nothing is missing.
COPPICE_API std::string missing_feature(const VkPhysicalDeviceFeatures2& enabled);

// What is known of the device.
struct Capabilities {
  std::string name, driver;
  std::uint32_t subgroup_size = 0;
  double timestamp_period_ns = 0;     // 0: no timestamps
  std::uint32_t loop_turn_limit = 0;  // what an old lavapipe allows an invocation; 0: no limit known
  std::string variants;               // of the stages that have some, "sort=scan,trace=binary"
};

// Everything that builders, sorters, scanners and tracers share. Any number of contexts and threads may
// record at once; objects made of a context must not outlive it.
class COPPICE_API Context {
 public:
  // A device of its own. Throws DeviceError if there is none or it cannot be used.
  explicit Context(const ContextOptions& options = {});
  // The caller's. Throws DeviceError, by name, for what it lacks.
  explicit Context(const AdoptedDevice& device, const ContextOptions& options = {});
  ~Context();
  Context(Context&&) noexcept;

  Capabilities capabilities() const;

  VkInstance instance() const;
  VkPhysicalDevice physical_device() const;
  VkDevice device() const;
  VkQueue queue() const;  // null where none was given
  std::uint32_t queue_family() const;

  // What the validation layers said since the last call; of a device of its own.
  std::vector<std::string> take_validation_messages();

  class State;  // the library's own
  State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

// A part of a buffer of the caller's. The buffer's usage includes VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
// STORAGE_BUFFER, TRANSFER_DST and INDIRECT_BUFFER, and its memory was allocated for device addresses.
struct MemoryRange {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;  // such that its address is a multiple of COPPICE_MEMORY_ALIGNMENT
  VkDeviceSize bytes = 0;
};

// A number that is known when the device gets there: a word, of which at most `maximum` count. With a null
// address it is `maximum`. A larger word counts as none in a Builder's builds, as `maximum` elsewhere; it
// sets COPPICE_ERROR_COUNT, or of rays COPPICE_ERROR_RAY_COUNT.
struct ElementCount {
  std::uint32_t maximum = 0;
  VkDeviceAddress address = 0;  // a multiple of 4
};

// Timestamps for a call: the time before its first kernel, then after each of its steps. Where there are
// fewer queries than steps the last ones get none. The caller resets them before. A step is a dispatch of a
// kernel, or clears that follow each other.
struct KernelQueries {
  VkQueryPool pool = VK_NULL_HANDLE;  // of timestamps
  std::uint32_t first = 0;
  std::uint32_t capacity = 0;
  const char** names = nullptr;  // capacity of them, or null; out: what ended at each query
  std::uint32_t written = 0;     // out: queries
};

}  // namespace coppice
