#include "gpu/device.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "gpu/address_space.h"
#include "gpu/no_driver.h"
#include "gpu/pipeline_store.h"
#include "gpu/suitability.h"

namespace coppice {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
// What a CPU driver, its compiler and a small scene take; with less some crash while they load.
constexpr std::uint64_t least_address_space = std::uint64_t{640} << 20;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* message, void* user) {
  auto& context = *static_cast<VulkanContext*>(user);
  const std::lock_guard lock(context.message_mutex);
  context.messages.emplace_back(message->pMessage);
  return VK_FALSE;
}

// The layer of 1.3.239 forgets the labels of a command buffer that has been freed in a thread of its own,
// also when the next one has the same handle: of 218 runs of a test 6 ended with bad_alloc in
// vkCmdBeginDebugUtilsLabelEXT, of 303 without labels none.
bool keeps_labels(const vk::LayerProperties& layer) {
  return layer.specVersion > VK_MAKE_API_VERSION(0, 1, 3, 239);
}

std::optional<vk::LayerProperties> find_validation_layer(const vk::raii::Context& loader) {
  for (const vk::LayerProperties& layer : loader.enumerateInstanceLayerProperties()) {
    if (!std::strcmp(layer.layerName, validation_layer)) return layer;
  }
  return std::nullopt;
}

vk::raii::Instance make_instance(const vk::raii::Context& loader, bool validate) {
  const vk::ApplicationInfo application("coppice", 1, "coppice", 1, VK_API_VERSION_1_3);
  std::vector<const char*> layers, extensions;
  const vk::ValidationFeatureEnableEXT enabled[] = {
      vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  // The layer's cache is one file for all processes, which it writes in place while others read it.
  const vk::ValidationFeatureDisableEXT disabled[] = {
      vk::ValidationFeatureDisableEXT::eShaderValidationCache};
  const vk::ValidationFeaturesEXT features(enabled, disabled);
  vk::InstanceCreateInfo info({}, &application);
  if (validate) {
    if (!find_validation_layer(loader))
      throw DeviceError(std::string("--validate: the layer ") + validation_layer + " is not installed");
    layers.push_back(validation_layer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.pNext = &features;
  }
  info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
  return vk::raii::Instance(loader, info);
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

// Of a device, whoever made it: what is recorded and submitted with, and what is known of it.
void equip(VulkanContext& context) {
  context.command_pool = vk::raii::CommandPool(context.device, {{}, context.queue_family}, context.allocator);
  const vk::SemaphoreTypeCreateInfo timeline(vk::SemaphoreType::eTimeline, 0);
  context.timeline =
      vk::raii::Semaphore(context.device, vk::SemaphoreCreateInfo({}, &timeline), context.allocator);
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, 128);
  context.pipeline_layout =
      vk::raii::PipelineLayout(context.device, vk::PipelineLayoutCreateInfo({}, {}, push), context.allocator);
  const auto families = context.physical.getQueueFamilyProperties();
  const std::uint32_t bits = context.timestamps ? families.at(context.queue_family).timestampValidBits : 0;
  context.timestamp_mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  context.properties = describe(context, bits);
}

void make_device(VulkanContext& context) {
  const auto families = context.physical.getQueueFamilyProperties();
  const auto family = std::ranges::find_if(
      families, [](const auto& f) { return bool(f.queueFlags & vk::QueueFlagBits::eCompute); });
  if (family == families.end()) throw DeviceError("device without a compute queue");
  context.queue_family = static_cast<std::uint32_t>(family - families.begin());

  const FeatureChain features = required_features();
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, context.queue_family, 1, &priority);
  vk::DeviceCreateInfo info({}, queue);
  info.pNext = &features.get<vk::PhysicalDeviceFeatures2>();
  context.device = vk::raii::Device(context.physical, info);
  context.queue = context.device.getQueue(context.queue_family, 0);
  equip(context);
}

// The handles of the caller's device, given back by ~VulkanContext.
void take_device(VulkanContext& context, const AdoptedDevice& given) {
  if (!given.instance || !given.physical_device || !given.device)
    throw DeviceError("an adopted device needs an instance, a physical device and a device");
  context.adopted = true;
  context.allocator = reinterpret_cast<const vk::AllocationCallbacks*>(given.allocator);
  context.instance = vk::raii::Instance(context.loader, given.instance);
  if (const std::string reason = why_unsuitable(context.instance); !reason.empty()) throw DeviceError(reason);
  context.physical = vk::raii::PhysicalDevice(context.instance, given.physical_device);
  const std::string name = context.physical.getProperties().deviceName.data();
  if (const std::string reason = why_unsuitable(context.physical); !reason.empty())
    throw DeviceError("unsuitable device: " + name + ": " + reason);
  if (!given.enabled_features)
    throw DeviceError(name +
                      ": enabled_features is null; which features the device was made with is not known");
  if (const std::string feature = missing_feature(*given.enabled_features); !feature.empty())
    throw DeviceError(name + ": the feature " + feature + " is not enabled");
  const auto families = context.physical.getQueueFamilyProperties();
  if (given.queue_family >= families.size() ||
      !(families[given.queue_family].queueFlags & vk::QueueFlagBits::eCompute))
    throw DeviceError(name + ": the queue family " + std::to_string(given.queue_family) + " cannot compute");
  context.queue_family = given.queue_family;
  context.device = vk::raii::Device(context.physical, given.device);
  const auto& functions = *context.device.getDispatcher();
  if (!functions.vkCmdPipelineBarrier2 || !functions.vkQueueSubmit2 || !functions.vkGetBufferDeviceAddress)
    throw DeviceError(name + ": the device has no functions of Vulkan 1.3");
  if (given.queue) context.queue = vk::raii::Queue(context.device, given.queue);
  equip(context);
  if (given.pipeline_cache) {
    context.adopted_cache = true;
    context.pipeline_cache = vk::raii::PipelineCache(context.device, given.pipeline_cache);
  }
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
    const vk::raii::Context loader(loader_entry());
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

// What goes wrong while a device is made or taken, as a DeviceError.
template <class Action>
void in_one_line(Action action) {
  try {
    action();
  } catch (const DeviceError&) {
    throw;
  } catch (const vk::IncompatibleDriverError&) {
    throw DeviceError(why_no_device());
  } catch (const std::runtime_error& error) {
    throw DeviceError(std::string("Vulkan: ") + error.what());
  }
}

}  // namespace

VulkanContext::~VulkanContext() {
  if (!adopted) return;
  pipelines.clear();
  pipeline_layout.clear();
  timeline.clear();
  command_pool.clear();
  if (adopted_cache) {
    (void)pipeline_cache.release();
  } else {
    pipeline_cache.clear();
  }
  queue = nullptr;
  (void)device.release();
  physical = nullptr;
  (void)instance.release();
}

Device::Device(const AdoptedDevice& device, std::filesystem::path pipeline_folder, Log log)
    : context_(std::make_unique<VulkanContext>(device.get_instance_proc_addr ? device.get_instance_proc_addr
                                                                             : loader_entry())) {
  context_->log = std::move(log);
  in_one_line([&] {
    take_device(*context_, device);
    load_pipelines(*context_, pipeline_folder);
  });
}

Device::Device(const DeviceOptions& options) {
  check_address_space(least_address_space, "");
  context_ = std::make_unique<VulkanContext>(loader_entry());
  VulkanContext& context = *context_;
  context.log = options.log;
  context.like_a_gpu = options.like_a_gpu;
  in_one_line([&] {
    context.timestamps = options.timestamps;
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
      context.labels = keeps_labels(*find_validation_layer(context.loader));
    }
    vk::raii::PhysicalDevices all(context.instance);
    std::vector<DeviceListing> listings;
    for (const auto& physical : all)
      listings.push_back(listing_of(physical, static_cast<std::uint32_t>(listings.size())));
    context.physical = std::move(all[choose_device(listings, options.select)]);
    make_device(context);
    load_pipelines(context, options.pipeline_folder);
  });
}

Device::~Device() {
  if (!context_) return;
  if (!context_->hung) store_pipelines(*context_);
  free_unless_hung(*context_, context_);
}
Device::Device(Device&&) noexcept = default;

const DeviceProperties& Device::properties() const { return context_->properties; }

VkInstance Device::instance() const { return *context_->instance; }
VkPhysicalDevice Device::physical_device() const { return *context_->physical; }
VkDevice Device::device() const { return *context_->device; }
VkQueue Device::queue() const { return *context_->queue; }
std::uint32_t Device::queue_family() const { return context_->queue_family; }

std::uint64_t Device::address_of(VkBuffer buffer) const {
  return vk::Device(*context_->device).getBufferAddress({buffer}, *context_->device.getDispatcher());
}

void Device::say(const std::string& line) const {
  if (context_->log) context_->log(line);
}

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
