// A Vulkan device as any program may have made it: nothing in here knows of trees. Its memory is mapped.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace consumer {

[[noreturn]] inline void fail(const std::string& why) {
  std::fprintf(stderr, "consumer: %s\n", why.c_str());
  std::exit(1);
}

inline void check(VkResult result, const char* what) {
  if (result != VK_SUCCESS) fail(std::string(what) + ": " + std::to_string(result));
}

// One of Vulkan's structures, all zero but for its type.
template <class Structure>
Structure structure(VkStructureType type) {
  Structure made{};
  made.sType = type;
  return made;
}

struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceAddress address = 0;
  std::byte* mapped = nullptr;
  VkDeviceSize bytes = 0;

  template <class T>
  std::span<T> as(VkDeviceSize offset = 0) const {
    return {reinterpret_cast<T*>(mapped + offset), (bytes - offset) / sizeof(T)};
  }
};

class OwnDevice {
 public:
  // `features`: a chain of what the device is made with.
  OwnDevice(const VkPhysicalDeviceFeatures2& features, bool validate) {
    make_instance(validate);
    std::uint32_t count = 1;
    if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0) fail("no Vulkan device");
    const float priority = 1;
    auto queue_info = structure<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue_info.queueFamilyIndex = family;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    auto info = structure<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
    vkGetDeviceQueue(device, family, 0, &queue);
    pool = make_pool();
  }

  ~OwnDevice() {
    for (const Buffer& buffer : buffers_) {
      vkDestroyBuffer(device, buffer.buffer, nullptr);
      vkFreeMemory(device, buffer.memory, nullptr);
    }
    for (const VkCommandPool one : pools_) vkDestroyCommandPool(device, one, nullptr);
    vkDestroyDevice(device, nullptr);
    if (messenger_) destroy_messenger();
    vkDestroyInstance(instance, nullptr);
  }
  OwnDevice(const OwnDevice&) = delete;
  OwnDevice& operator=(const OwnDevice&) = delete;

  // Zero at the start; freed with the device.
  Buffer make_buffer(VkDeviceSize bytes) {
    Buffer made{.bytes = bytes};
    auto info = structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    check(vkCreateBuffer(device, &info, nullptr, &made.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, made.buffer, &needs);
    auto flags = structure<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    auto allocation = structure<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.pNext = &flags;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = mapped_type(needs.memoryTypeBits);
    check(vkAllocateMemory(device, &allocation, nullptr, &made.memory), "vkAllocateMemory");
    check(vkBindBufferMemory(device, made.buffer, made.memory, 0), "vkBindBufferMemory");
    void* mapped = nullptr;
    check(vkMapMemory(device, made.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    made.mapped = static_cast<std::byte*>(mapped);
    std::memset(made.mapped, 0, bytes);
    const VkBufferDeviceAddressInfo which{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, made.buffer};
    made.address = vkGetBufferDeviceAddress(device, &which);
    buffers_.push_back(made);
    return made;
  }

  template <class T>
  Buffer upload(std::span<const T> values) {
    const Buffer made = make_buffer(values.size_bytes() + 256);
    std::memcpy(made.mapped, values.data(), values.size_bytes());
    return made;
  }

  VkCommandPool make_pool() {
    auto info = structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    info.queueFamilyIndex = family;
    VkCommandPool made = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device, &info, nullptr, &made), "vkCreateCommandPool");
    pools_.push_back(made);
    return made;
  }

  VkCommandBuffer begin() { return begin(pool); }
  VkCommandBuffer begin(VkCommandPool from) {
    auto info = structure<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = from;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
    const auto begin_info = structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    check(vkBeginCommandBuffer(commands, &begin_info), "vkBeginCommandBuffer");
    return commands;
  }

  // What compute shaders and transfers have written, for shaders that follow and for the host.
  static void barrier(VkCommandBuffer commands) {
    auto memory = structure<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    memory.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    memory.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                           VK_ACCESS_2_HOST_READ_BIT;
    auto info = structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands, &info);
  }

  // Ends the commands and waits for them, for a minute or two.
  void run(VkCommandBuffer commands) {
    barrier(commands);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    const auto fence_info = structure<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(device, &fence_info, nullptr, &fence), "vkCreateFence");
    auto submit = structure<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(queue, 1, &submit, fence), "vkQueueSubmit");
    check(vkWaitForFences(device, 1, &fence, VK_TRUE, 120'000'000'000), "vkWaitForFences");
    vkDestroyFence(device, fence, nullptr);
  }

  std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  static constexpr std::uint32_t family = 0;

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                   VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* message,
                                                   void* user) {
    auto& own = *static_cast<OwnDevice*>(user);
    const std::lock_guard lock(own.message_mutex_);
    own.messages_.emplace_back(message->pMessage);
    return VK_FALSE;
  }

  void make_instance(bool validate) {
    auto application = structure<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = VK_API_VERSION_1_3;
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    auto validation = structure<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    validation.enabledValidationFeatureCount = 1;
    validation.pEnabledValidationFeatures = &enabled;
    // One file for all processes, which the layer writes in place while others read it.
    const VkValidationFeatureDisableEXT disabled = VK_VALIDATION_FEATURE_DISABLE_SHADER_VALIDATION_CACHE_EXT;
    validation.disabledValidationFeatureCount = 1;
    validation.pDisabledValidationFeatures = &disabled;
    auto info = structure<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    if (validate) {
      info.pNext = &validation;
      info.enabledLayerCount = info.enabledExtensionCount = 1;
      info.ppEnabledLayerNames = &layer;
      info.ppEnabledExtensionNames = &extension;
    }
    check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    if (validate) make_messenger();
  }

  void make_messenger() {
    auto info = structure<VkDebugUtilsMessengerCreateInfoEXT>(
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = this;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    check(create(instance, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
  }

  void destroy_messenger() {
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, messenger_, nullptr);
  }

  std::uint32_t mapped_type(std::uint32_t allowed) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    constexpr VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      if ((allowed >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
    }
    fail("no mapped memory");
  }

  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::mutex message_mutex_;
  std::vector<std::string> messages_;
  std::vector<Buffer> buffers_;
  std::vector<VkCommandPool> pools_;
};

}  // namespace consumer
