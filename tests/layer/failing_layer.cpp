// A Vulkan layer between a program and the driver that lets the device fail as real ones do, when the file
// that COPPICE_DEVICE_FAILS names is there. What it holds says how:
//   lost      the device is lost at its next submit, for good; the file is removed, so that another one works
//   lost all  the same, and so is every device that is made after it
//   hangs     what is submitted from now on does not come to an end
// Memory is refused in pieces larger than COPPICE_LARGEST_ALLOCATION, in bytes, where that is set.
#include <unistd.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

// Of the one instance and the one device at a time that a program has.
VkInstance instance_below = VK_NULL_HANDLE;
PFN_vkGetInstanceProcAddr next_of_instance = nullptr;
PFN_vkGetDeviceProcAddr next_of_device = nullptr;
VkDevice device_below = VK_NULL_HANDLE;
bool is_lost = false, hangs = false;

template <class Function>
Function below(const char* name) {
  return reinterpret_cast<Function>(next_of_device(device_below, name));
}

void look_for_failure() {
  const char* const name = std::getenv("COPPICE_DEVICE_FAILS");
  std::FILE* const file = name ? std::fopen(name, "r") : nullptr;
  if (!file) return;
  char line[32] = "";
  const bool read = std::fgets(line, sizeof line, file) != nullptr;
  std::fclose(file);
  const std::string how = read ? line : "";
  is_lost = is_lost || how == "lost" || how == "lost all";
  hangs = hangs || how == "hangs";
  if (how == "lost") std::remove(name);
}

template <class Submit>
VkResult submit_below(Submit submit) {
  look_for_failure();
  if (is_lost) return VK_ERROR_DEVICE_LOST;
  return hangs ? VK_SUCCESS : submit();
}

[[noreturn]] VkResult wait_for_good() {
  while (true) pause();
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits,
                                            VkFence fence) {
  return submit_below(
      [&] { return below<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, count, submits, fence); });
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* submits,
                                             VkFence fence) {
  return submit_below(
      [&] { return below<PFN_vkQueueSubmit2>("vkQueueSubmit2")(queue, count, submits, fence); });
}

// It would wait for what was drawn.
VKAPI_ATTR VkResult VKAPI_CALL queue_present(VkQueue queue, const VkPresentInfoKHR* info) {
  return hangs ? VK_SUCCESS : below<PFN_vkQueuePresentKHR>("vkQueuePresentKHR")(queue, info);
}

// Whoever gives a limit is told at once that it is over.
VKAPI_ATTR VkResult VKAPI_CALL wait_semaphores(VkDevice device, const VkSemaphoreWaitInfo* info,
                                               std::uint64_t limit) {
  return hangs ? VK_TIMEOUT : below<PFN_vkWaitSemaphores>("vkWaitSemaphores")(device, info, limit);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences,
                                               VkBool32 all, std::uint64_t limit) {
  return hangs ? VK_TIMEOUT
               : below<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, limit);
}

VKAPI_ATTR VkResult VKAPI_CALL device_wait_idle(VkDevice device) {
  return hangs ? wait_for_good() : below<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle")(device);
}

VKAPI_ATTR VkResult VKAPI_CALL queue_wait_idle(VkQueue queue) {
  return hangs ? wait_for_good() : below<PFN_vkQueueWaitIdle>("vkQueueWaitIdle")(queue);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* callbacks,
                                               VkDeviceMemory* memory) {
  const char* const largest = std::getenv("COPPICE_LARGEST_ALLOCATION");
  if (largest && info->allocationSize > std::strtoull(largest, nullptr, 10))
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return below<PFN_vkAllocateMemory>("vkAllocateMemory")(device, info, callbacks, memory);
}

// What the loader gives a layer on the way down.
template <class LayerInfo, VkStructureType type, class Info>
LayerInfo* link_of(const Info* info) {
  auto* link = static_cast<const LayerInfo*>(info->pNext);
  while (link && !(link->sType == type && link->function == VK_LAYER_LINK_INFO))
    link = static_cast<const LayerInfo*>(link->pNext);
  return const_cast<LayerInfo*>(link);
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* callbacks, VkInstance* instance) {
  auto* const link = link_of<VkLayerInstanceCreateInfo, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO>(info);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(next_of_instance(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, callbacks, instance);
  if (result == VK_SUCCESS) instance_below = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* callbacks, VkDevice* device) {
  auto* const link = link_of<VkLayerDeviceCreateInfo, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO>(info);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(next(instance_below, "vkCreateDevice"));
  const VkResult result = create(physical, info, callbacks, device);
  if (result == VK_SUCCESS) device_below = *device;
  is_lost = false;
  return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name);

struct Named {
  const char* name;
  PFN_vkVoidFunction function;
};

template <class Function>
Named named(const char* name, Function function) {
  return {name, reinterpret_cast<PFN_vkVoidFunction>(function)};
}

PFN_vkVoidFunction own_device_function(const char* name) {
  for (const Named& own :
       {named("vkGetDeviceProcAddr", device_function), named("vkQueueSubmit", queue_submit),
        named("vkQueueSubmit2", queue_submit2), named("vkQueuePresentKHR", queue_present),
        named("vkWaitSemaphores", wait_semaphores), named("vkWaitForFences", wait_for_fences),
        named("vkDeviceWaitIdle", device_wait_idle), named("vkQueueWaitIdle", queue_wait_idle),
        named("vkAllocateMemory", allocate_memory)}) {
    if (!std::strcmp(own.name, name)) return own.function;
  }
  return nullptr;
}

PFN_vkVoidFunction device_function(VkDevice device, const char* name) {
  const PFN_vkVoidFunction own = own_device_function(name);
  return own ? own : next_of_device(device, name);
}

PFN_vkVoidFunction instance_function(VkInstance instance, const char* name) {
  for (const Named& own :
       {named("vkGetInstanceProcAddr", instance_function), named("vkCreateInstance", create_instance),
        named("vkCreateDevice", create_device)}) {
    if (!std::strcmp(own.name, name)) return own.function;
  }
  const PFN_vkVoidFunction own = own_device_function(name);
  return own ? own : next_of_instance(instance, name);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated) {
  negotiated->loaderLayerInterfaceVersion = 2;
  negotiated->pfnGetInstanceProcAddr = instance_function;
  negotiated->pfnGetDeviceProcAddr = device_function;
  negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
