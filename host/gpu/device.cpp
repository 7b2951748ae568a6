#include "gpu/device.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "gpu/address_space.h"
#include "gpu/no_driver.h"
#include "gpu/pipeline_store.h"
#include "gpu/vulkan_context.h"

namespace coppice {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
// What a CPU driver, its compiler and a small scene take; with less some crash while they load.
constexpr std::uint64_t least_address_space = std::uint64_t{640} << 20;

DeviceType device_type(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return DeviceType::discrete;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return DeviceType::integrated;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return DeviceType::virtual_gpu;
    case vk::PhysicalDeviceType::eCpu:
      return DeviceType::cpu;
    default:
      return DeviceType::other;
  }
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* message, void* user) {
  auto& context = *static_cast<VulkanContext*>(user);
  const std::lock_guard lock(context.message_mutex);
  context.messages.emplace_back(message->pMessage);
  return VK_FALSE;
}

vk::raii::Instance make_instance(const vk::raii::Context& loader, bool validate) {
  const vk::ApplicationInfo application("coppice", 1, "coppice", 1, VK_API_VERSION_1_3);
  std::vector<const char*> layers, extensions;
  const vk::ValidationFeatureEnableEXT enabled[] = {
      vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features(enabled);
  vk::InstanceCreateInfo info({}, &application);
  if (validate) {
    const auto available = loader.enumerateInstanceLayerProperties();
    if (std::ranges::none_of(
            available, [](const auto& layer) { return !std::strcmp(layer.layerName, validation_layer); })) {
      throw DeviceError(std::string("--validate: the layer ") + validation_layer + " is not installed");
    }
    layers.push_back(validation_layer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.pNext = &features;
  }
  info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
  return vk::raii::Instance(loader, info);
}

using FeatureChain = vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                        vk::PhysicalDeviceVulkan13Features>;

// What the kernels need, one line a feature.
template <class Visit>
void for_each_feature(FeatureChain& chain, Visit visit) {
  auto& vulkan12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  auto& vulkan13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  visit(chain.get<vk::PhysicalDeviceFeatures2>().features.shaderInt64, "shaderInt64");
  visit(vulkan12.bufferDeviceAddress, "bufferDeviceAddress");
  visit(vulkan12.scalarBlockLayout, "scalarBlockLayout");
  visit(vulkan13.synchronization2, "synchronization2");
  visit(vulkan13.maintenance4, "maintenance4");
  visit(vulkan13.subgroupSizeControl, "subgroupSizeControl");
  visit(vulkan13.computeFullSubgroups, "computeFullSubgroups");
}

std::string why_unsuitable(const vk::raii::PhysicalDevice& physical) {
  const auto properties =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                              vk::PhysicalDeviceVulkan12Properties, vk::PhysicalDeviceVulkan13Properties>();
  const auto& core = properties.get<vk::PhysicalDeviceProperties2>().properties;
  if (core.apiVersion < VK_API_VERSION_1_3) return "no Vulkan 1.3";
  const auto& subgroups = properties.get<vk::PhysicalDeviceVulkan11Properties>();
  const auto needed = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eVote |
                      vk::SubgroupFeatureFlagBits::eArithmetic | vk::SubgroupFeatureFlagBits::eBallot |
                      vk::SubgroupFeatureFlagBits::eShuffle;
  if ((subgroups.subgroupSupportedOperations & needed) != needed) return "no subgroup arithmetic or shuffle";
  if (subgroups.subgroupSize < 4) return "subgroups of fewer than 4 invocations";
  if (subgroups.subgroupSize > 64) return "subgroups of more than 64 invocations";
  const auto& sizes = properties.get<vk::PhysicalDeviceVulkan13Properties>();
  if (sizes.minSubgroupSize < sizes.maxSubgroupSize &&
      !(sizes.requiredSubgroupSizeStages & vk::ShaderStageFlagBits::eCompute))
    return "subgroups of several sizes, and none can be required";
  const auto& floats = properties.get<vk::PhysicalDeviceVulkan12Properties>();
  if (!floats.shaderRoundingModeRTEFloat32) return "no rounding to nearest even";
  if (!floats.shaderSignedZeroInfNanPreserveFloat32) return "no infinities and NaN";
  if (core.limits.maxComputeWorkGroupInvocations < 256) return "no workgroups of 256 invocations";
  if (core.limits.maxComputeSharedMemorySize < 32768) return "less than 32 KiB of shared memory";
  auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                        vk::PhysicalDeviceVulkan13Features>();
  std::string missing;
  for_each_feature(features, [&](vk::Bool32& supported, const char* name) {
    if (!supported && missing.empty()) missing = std::string("no ") + name;
  });
  return missing;
}

DeviceListing listing_of(const vk::raii::PhysicalDevice& physical, std::uint32_t index) {
  const auto properties =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto& core = properties.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = properties.get<vk::PhysicalDeviceDriverProperties>();
  return {index, core.deviceName.data(), driver.driverInfo.data(), device_type(core.deviceType),
          why_unsuitable(physical)};
}

std::uint32_t choose_device(const std::vector<DeviceListing>& devices, const std::string& select) {
  if (devices.empty()) throw DeviceError(why_no_device());
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(select.data(), select.data() + select.size(), index);
  const bool is_index = !select.empty() && error == std::errc() && end == select.data() + select.size();
  const DeviceListing* best = nullptr;
  std::string reason;
  for (const DeviceListing& device : devices) {
    const bool wanted = is_index ? device.index == index : device.name.find(select) != std::string::npos;
    if (wanted && !device.unsuitable_because.empty()) reason = device.name + ": " + device.unsuitable_because;
    if (!wanted || !device.unsuitable_because.empty()) continue;
    if (!best || device.type < best->type) best = &device;
  }
  if (best) return best->index;
  if (!reason.empty()) throw DeviceError("unsuitable device: " + reason);
  throw DeviceError("--device: no device '" + select + "' (see 'coppice devices')");
}

// Mesa's lavapipe 22.3 ends long loops silently, 25.0 does not; those between are taken to. docs/numerics.md,
// "Loop turns".
std::uint32_t known_loop_limit(const vk::PhysicalDeviceDriverProperties& driver) {
  if (driver.driverID != vk::DriverId::eMesaLlvmpipe) return 0;
  int major = 0;
  const std::string_view version = driver.driverInfo.data();
  if (version.starts_with("Mesa "))
    std::from_chars(version.data() + 5, version.data() + version.size(), major);
  return major < 25 ? 65535 : 0;
}

DeviceProperties describe(const VulkanContext& context, std::uint32_t timestamp_bits) {
  const auto chain =
      context.physical
          .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                          vk::PhysicalDeviceVulkan13Properties, vk::PhysicalDeviceDriverProperties>();
  const auto& core = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  DeviceProperties properties;
  properties.name = core.deviceName.data();
  properties.driver = driver.driverInfo.data();
  properties.type = device_type(core.deviceType);
  properties.subgroup_size = chain.get<vk::PhysicalDeviceVulkan11Properties>().subgroupSize;
  const auto& sizes = chain.get<vk::PhysicalDeviceVulkan13Properties>();
  properties.has_subgroup_sizes = sizes.minSubgroupSize < sizes.maxSubgroupSize;
  properties.max_block_bytes =
      std::min<std::uint64_t>(chain.get<vk::PhysicalDeviceVulkan11Properties>().maxMemoryAllocationSize,
                              chain.get<vk::PhysicalDeviceVulkan13Properties>().maxBufferSize);
  properties.memory_bytes = 0;
  const auto memory = context.physical.getMemoryProperties();
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const vk::MemoryHeap& heap = memory.memoryHeaps[i];
    if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal)
      properties.memory_bytes = std::max<std::uint64_t>(properties.memory_bytes, heap.size);
  }
  properties.timestamp_period_ns = timestamp_bits ? core.limits.timestampPeriod : 0.0;
  properties.shared_memory = !context.like_a_gpu && (properties.type == DeviceType::cpu ||
                                                     properties.type == DeviceType::integrated);
  properties.lanes_in_step = !context.like_a_gpu && properties.type == DeviceType::cpu;
  properties.loop_turn_limit = known_loop_limit(driver);
  return properties;
}

void make_device(VulkanContext& context) {
  const auto families = context.physical.getQueueFamilyProperties();
  const auto family = std::ranges::find_if(
      families, [](const auto& f) { return bool(f.queueFlags & vk::QueueFlagBits::eCompute); });
  if (family == families.end()) throw DeviceError("device without a compute queue");
  context.queue_family = static_cast<std::uint32_t>(family - families.begin());

  FeatureChain features;
  for_each_feature(features, [](vk::Bool32& enable, const char*) { enable = VK_TRUE; });
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, context.queue_family, 1, &priority);
  vk::DeviceCreateInfo info({}, queue);
  info.pNext = &features.get<vk::PhysicalDeviceFeatures2>();
  context.device = vk::raii::Device(context.physical, info);
  context.queue = context.device.getQueue(context.queue_family, 0);
  context.command_pool = vk::raii::CommandPool(context.device, {{}, context.queue_family});
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, 128);
  context.pipeline_layout =
      vk::raii::PipelineLayout(context.device, vk::PipelineLayoutCreateInfo({}, {}, push));
  const std::uint32_t bits = context.timestamps ? family->timestampValidBits : 0;
  context.timestamp_mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  context.properties = describe(context, bits);
}

}  // namespace

const char* to_string(DeviceType type) {
  constexpr const char* names[] = {"discrete", "integrated", "virtual", "cpu", "other"};
  return names[static_cast<int>(type)];
}

std::uint32_t VulkanContext::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const {
  const auto memory = physical.getMemoryProperties();
  for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    if ((allowed >> type & 1) && (memory.memoryTypes[type].propertyFlags & flags) == flags) return type;
  }
  throw DeviceError("device has no memory of the kind '" + vk::to_string(flags) + "'");
}

std::vector<DeviceListing> list_devices() {
  check_address_space(least_address_space, "");
  std::vector<DeviceListing> devices;
  try {
    const vk::raii::Context loader;
    const vk::raii::Instance instance = make_instance(loader, false);
    for (const auto& physical : vk::raii::PhysicalDevices(instance)) {
      devices.push_back(listing_of(physical, static_cast<std::uint32_t>(devices.size())));
    }
  } catch (const std::runtime_error&) {
    devices.clear();  // no loader, which is no vk::SystemError, or a loader without any driver
  }
  return devices;
}

namespace {

std::unique_ptr<VulkanContext> make_context() {
  check_address_space(least_address_space, "");
  try {
    return std::make_unique<VulkanContext>();
  } catch (const std::runtime_error&) {  // no loader
    throw DeviceError(why_no_device());
  }
}

}  // namespace

Device::Device(const DeviceOptions& options) : context_(make_context()) {
  VulkanContext& context = *context_;
  context.like_a_gpu = options.like_a_gpu;
  try {
    const char* const no_timestamps = std::getenv("COPPICE_NO_TIMESTAMPS");
    context.timestamps = options.timestamps && !(no_timestamps && *no_timestamps);
    context.instance = make_instance(context.loader, options.validate);
    if (options.validate) {
      using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
      using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
      context.messenger =
          vk::raii::DebugUtilsMessengerEXT(context.instance, {{},
                                                              Severity::eWarning | Severity::eError,
                                                              Type::eValidation | Type::ePerformance,
                                                              on_message,
                                                              &context});
      context.labels = true;
    }
    vk::raii::PhysicalDevices all(context.instance);
    std::vector<DeviceListing> listings;
    for (const auto& physical : all)
      listings.push_back(listing_of(physical, static_cast<std::uint32_t>(listings.size())));
    context.physical = std::move(all[choose_device(listings, options.select)]);
    make_device(context);
    load_pipelines(context, options.pipeline_folder);
  } catch (const DeviceError&) {
    throw;
  } catch (const vk::IncompatibleDriverError&) {
    throw DeviceError(why_no_device());
  } catch (const std::runtime_error& error) {
    throw DeviceError(std::string("Vulkan: ") + error.what());
  }
}

Device::~Device() {
  if (context_) store_pipelines(*context_);
}
Device::Device(Device&&) noexcept = default;

const DeviceProperties& Device::properties() const { return context_->properties; }

bool Device::has_kept_pipelines() const { return !context_->kept_pipelines.empty(); }

std::filesystem::path Device::kept_file(std::string_view stem) const {
  if (context_->pipeline_file.empty()) return {};
  return context_->pipeline_file.parent_path() / file_name_of(stem, context_->physical);
}

std::filesystem::path cache_folder() {
  // The XDG specification says that a relative path is to be ignored.
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg && std::filesystem::path(xdg).is_absolute()) return std::filesystem::path(xdg) / "coppice";
  const char* const home = std::getenv("HOME");
  return home && *home ? std::filesystem::path(home) / ".cache" / "coppice" : std::filesystem::path();
}

std::vector<std::string> Device::take_validation_messages() {
  const std::lock_guard lock(context_->message_mutex);
  return std::exchange(context_->messages, {});
}

}  // namespace coppice
