#include "view/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <charconv>
#include <mutex>
#include <utility>

#include "gpu/device.h"

namespace coppice {

struct Window::Messages {
  std::mutex mutex;
  std::vector<std::string> list;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
};

namespace {

constexpr const char* layer_name = "VK_LAYER_KHRONOS_validation";

std::string& glfw_error() {
  static std::string text;
  return text;
}

void note_glfw_error(int, const char* text) { glfw_error() = text; }

VKAPI_ATTR VkBool32 VKAPI_CALL on_view_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* message,
                                               void* user) {
  auto& [mutex, list] = *static_cast<std::pair<std::mutex*, std::vector<std::string>*>*>(user);
  const std::lock_guard lock(*mutex);
  list->emplace_back(message->pMessage);
  return VK_FALSE;
}

// The first family that computes, draws and presents; -1 for none.
int presenting_family(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    constexpr VkQueueFlags needed = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
    VkBool32 presents = VK_FALSE;
    if ((families[i].queueFlags & needed) == needed &&
        vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface, &presents) == VK_SUCCESS && presents)
      return static_cast<int>(i);
  }
  return -1;
}

bool has_swapchain(VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
  return std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
    return std::string_view(extension.extensionName) == VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  });
}

bool has_layer() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::ranges::any_of(
      layers, [](const VkLayerProperties& layer) { return std::string_view(layer.layerName) == layer_name; });
}

// Discrete before integrated before virtual before CPU.
int rank_of(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 3;
    default:
      return 4;
  }
}

}  // namespace

void check_vulkan(VkResult result, const char* what) {
  if (result >= 0) return;
  const char* name = "";
  switch (result) {
    case VK_ERROR_DEVICE_LOST:
      throw DeviceLost(std::string(what) + ": the device was lost");
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      name = "the device has no memory left";
      break;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      name = "the host has no memory left";
      break;
    case VK_ERROR_SURFACE_LOST_KHR:
      name = "the window's surface was lost";
      break;
    default:
      throw DeviceError(std::string(what) + ": Vulkan's error " + std::to_string(result));
  }
  throw DeviceError(std::string(what) + ": " + name);
}

Window::Window(const WindowOptions& options) : messages_(std::make_unique<Messages>()) {
  glfwSetErrorCallback(note_glfw_error);
  if (!glfwInit()) throw DeviceError("no window: " + glfw_error() + " (it needs a display: is DISPLAY set?)");
  try {
    if (!glfwVulkanSupported()) throw DeviceError("no window: no Vulkan driver presents to this display");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
    if (!window_) throw DeviceError("no window: " + glfw_error());
    make_instance(options.validate);
    check_vulkan(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "the window's surface");
    choose_device(options.select);
    make_device();
  } catch (...) {
    destroy();
    throw;
  }
}

Window::~Window() { destroy(); }

void Window::destroy() {
  if (device) vkDestroyDevice(device, nullptr);
  if (surface) vkDestroySurfaceKHR(instance, surface, nullptr);
  if (messages_->messenger) {
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy_messenger(instance, messages_->messenger, nullptr);
  }
  if (instance) vkDestroyInstance(instance, nullptr);
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::make_instance(bool validate) {
  std::uint32_t count = 0;
  const char** const needed = glfwGetRequiredInstanceExtensions(&count);
  if (!needed) throw DeviceError("no window: Vulkan's loader knows no surfaces of this display");
  std::vector<const char*> extensions(needed, needed + count);
  if (validate && !has_layer())
    throw DeviceError(std::string("--validate: the layer ") + layer_name + " is not installed");
  if (validate) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeatureDisableEXT disabled = VK_VALIDATION_FEATURE_DISABLE_SHADER_VALIDATION_CACHE_EXT;
  const VkValidationFeaturesEXT features{
      VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, nullptr, 1, &enabled, 1, &disabled};
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "coppice";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pNext = validate ? &features : nullptr;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = validate ? 1 : 0;
  info.ppEnabledLayerNames = &layer_name;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check_vulkan(vkCreateInstance(&info, nullptr, &instance), "Vulkan's instance");
  if (!validate) return;
  static std::pair<std::mutex*, std::vector<std::string>*> target;
  target = {&messages_->mutex, &messages_->list};
  VkDebugUtilsMessengerCreateInfoEXT messenger{};
  messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  messenger.pfnUserCallback = on_view_message;
  messenger.pUserData = &target;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  check_vulkan(create(instance, &messenger, nullptr, &messages_->messenger), "the validation's messenger");
}

void Window::choose_device(const std::string& select) {
  std::uint32_t count = 0;
  check_vulkan(vkEnumeratePhysicalDevices(instance, &count, nullptr), "Vulkan's devices");
  std::vector<VkPhysicalDevice> devices(count);
  check_vulkan(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "Vulkan's devices");
  std::uint32_t wanted_index = 0;
  const char* const end = select.data() + select.size();
  const auto [last, error] = std::from_chars(select.data(), end, wanted_index);
  const bool is_index = !select.empty() && error == std::errc() && last == end;
  std::string reason;
  int best = 5;
  for (std::uint32_t i = 0; i < count; ++i) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(devices[i], &properties);
    const std::string name = properties.deviceName;
    if (is_index ? i != wanted_index : name.find(select) == std::string::npos) continue;
    std::string lacks = why_unsuitable(instance, devices[i]);
    const int family = presenting_family(devices[i], surface);
    if (lacks.empty() && (family < 0 || !has_swapchain(devices[i])))
      lacks = "it cannot present to this display";
    if (!lacks.empty()) {
      reason = name + ": " + lacks;
    } else if (rank_of(properties.deviceType) < best) {
      best = rank_of(properties.deviceType);
      physical = devices[i];
      queue_family = static_cast<std::uint32_t>(family);
    }
  }
  if (physical) return;
  if (!reason.empty()) throw DeviceError("unsuitable device: " + reason);
  throw NoSuchDevice("no device '" + select + "'");
}

void Window::make_device() {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info{};
  queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue_info.queueFamilyIndex = queue_family;
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features_.features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue_info;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  check_vulkan(vkCreateDevice(physical, &info, nullptr, &device), "the device");
  vkGetDeviceQueue(device, queue_family, 0, &queue);
}

void Window::remake_device() {
  vkDestroyDevice(device, nullptr);
  device = VK_NULL_HANDLE;
  make_device();
}

AdoptedDevice Window::adopted() const {
  AdoptedDevice given;
  given.instance = instance;
  given.physical_device = physical;
  given.device = device;
  given.queue_family = queue_family;
  given.enabled_features = &features_.features;
  given.queue = queue;
  return given;
}

VkExtent2D Window::framebuffer() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return {0, 0};
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

std::vector<std::string> Window::take_validation_messages() {
  const std::lock_guard lock(messages_->mutex);
  return std::exchange(messages_->list, {});
}

}  // namespace coppice
