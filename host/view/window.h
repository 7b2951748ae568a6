#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>
#include <vector>

#include "coppice/context.h"

struct GLFWwindow;

namespace coppice {

// Throws DeviceError, with the name of the result, unless it is success; DeviceLost where it is that.
void check_vulkan(VkResult result, const char* what);

struct WindowOptions {
  std::string title = "coppice";
  int width = 1280, height = 800;  // pixels
  std::string select{};            // as DeviceOptions::select
  bool validate = false;
};

// A window of the desktop, and a Vulkan device that computes, draws and presents to it, made with what
// Coppice needs: any program might have made it. Drawing is others' (screen.h).
class Window {
 public:
  // Throws DeviceError in one line: no display, no device that presents there.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;

  // Valid while the window lives.
  AdoptedDevice adopted() const;

  // In place of one that was lost, after all that was made of it has been freed. Throws DeviceError.
  void remake_device();

  GLFWwindow* handle() const { return window_; }
  VkExtent2D framebuffer() const;  // 0 where the window is not to be seen

  std::vector<std::string> take_validation_messages();

  VkInstance instance = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;

 private:
  struct Messages;

  void make_instance(bool validate);
  void choose_device(const std::string& select);
  void make_device();
  void destroy();

  GLFWwindow* window_ = nullptr;
  RequiredFeatures features_;
  std::unique_ptr<Messages> messages_;
};

}  // namespace coppice
