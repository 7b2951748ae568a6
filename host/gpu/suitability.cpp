#include "gpu/suitability.h"

#include <charconv>

#include "gpu/no_driver.h"

namespace coppice {

namespace {

// Calls `visit(member, name)` for each feature that is needed, in the structure that has it.
template <class Core, class Vulkan12, class Vulkan13, class Visit>
void for_each_feature(Core& core, Vulkan12& vulkan12, Vulkan13& vulkan13, Visit visit) {
  visit(core.shaderInt64, "shaderInt64");
  visit(vulkan12.bufferDeviceAddress, "bufferDeviceAddress");
  visit(vulkan12.scalarBlockLayout, "scalarBlockLayout");
  visit(vulkan12.timelineSemaphore, "timelineSemaphore");
  visit(vulkan13.synchronization2, "synchronization2");
  visit(vulkan13.maintenance4, "maintenance4");
  visit(vulkan13.subgroupSizeControl, "subgroupSizeControl");
  visit(vulkan13.computeFullSubgroups, "computeFullSubgroups");
}

template <class Visit>
void for_each_feature(FeatureChain& chain, Visit visit) {
  for_each_feature(chain.get<vk::PhysicalDeviceFeatures2>().features,
                   chain.get<vk::PhysicalDeviceVulkan12Features>(),
                   chain.get<vk::PhysicalDeviceVulkan13Features>(), visit);
}

// The structure of the chain that `type` names; null where there is none.
template <class Structure>
const Structure* find_structure(const VkPhysicalDeviceFeatures2& chain, VkStructureType type) {
  for (auto next = static_cast<const VkBaseInStructure*>(chain.pNext); next; next = next->pNext) {
    if (next->sType == type) return reinterpret_cast<const Structure*>(next);
  }
  return nullptr;
}

}  // namespace

FeatureChain required_features() {
  FeatureChain chain;
  for_each_feature(chain, [](vk::Bool32& enable, const char*) { enable = VK_TRUE; });
  return chain;
}

RequiredFeatures::RequiredFeatures() {
  const FeatureChain chain = required_features();
  features = chain.get<vk::PhysicalDeviceFeatures2>();
  vulkan12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  vulkan13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  features.pNext = &vulkan12;
  vulkan12.pNext = &vulkan13;
  vulkan13.pNext = nullptr;
}

std::string missing_feature(const VkPhysicalDeviceFeatures2& enabled) {
  static constexpr VkPhysicalDeviceVulkan12Features no_12{};
  static constexpr VkPhysicalDeviceVulkan13Features no_13{};
  const auto* vulkan12 = find_structure<VkPhysicalDeviceVulkan12Features>(
      enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  const auto* vulkan13 = find_structure<VkPhysicalDeviceVulkan13Features>(
      enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  std::string missing;
  for_each_feature(enabled.features, vulkan12 ? *vulkan12 : no_12, vulkan13 ? *vulkan13 : no_13,
                   [&](const VkBool32& feature, const char* name) {
                     if (!feature && missing.empty()) missing = name;
                   });
  return missing;
}

std::string why_unsuitable(const vk::raii::Instance& instance) {
  // Loaders give no functions that are newer than what an instance was made for.
  return instance.getDispatcher()->vkGetPhysicalDeviceProperties2
             ? ""
             : "the instance was made for less than Vulkan 1.3";
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

std::string why_unsuitable(VkInstance instance, VkPhysicalDevice physical_device,
                           PFN_vkGetInstanceProcAddr get_instance_proc_addr) {
  struct Borrowed {
    vk::raii::Instance instance;
    ~Borrowed() { (void)instance.release(); }
  };
  const vk::raii::Context loader(get_instance_proc_addr ? get_instance_proc_addr : loader_entry());
  const Borrowed borrowed{vk::raii::Instance(loader, instance)};
  const std::string reason = why_unsuitable(borrowed.instance);
  return reason.empty() ? why_unsuitable(vk::raii::PhysicalDevice(borrowed.instance, physical_device))
                        : reason;
}

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
  throw NoSuchDevice("no device '" + select + "'");
}

}  // namespace coppice
