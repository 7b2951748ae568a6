#pragma once

#include <cstdint>

#include "view/swapchain.h"

struct ImDrawData;

namespace coppice {

// A picture in a buffer of the device, RGBA8, rows top to bottom. No buffer: none.
struct PicturePlace {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  std::uint32_t width = 0, height = 0;
};

// What the window shows: a picture over all of it, and what Dear ImGui draws over that.
class Screen {
 public:
  // Makes Dear ImGui's context, and its back ends for GLFW and Vulkan.
  explicit Screen(const Window& window);
  ~Screen();
  Screen(const Screen&) = delete;

  // Begins a frame of Dear ImGui.
  void begin();

  // Ends it, and shows it over the picture, which nothing writes meanwhile. False where nothing can be shown
  // now: the window has no size.
  bool show(const PicturePlace& picture);

  VkExtent2D extent() const { return swapchain_.extent(); }

  // Waits until the device has done all that it was given.
  void wait();

 private:
  void make_imgui();
  void make_picture(std::uint32_t width, std::uint32_t height);
  void free_picture();
  void remake();
  void wait_for_last();
  void record(const PicturePlace& picture, std::uint32_t index, ImDrawData* data);
  void record_picture(const PicturePlace& picture, VkImage target);

  const Window& window_;
  Swapchain swapchain_;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence done_ = VK_NULL_HANDLE;
  VkSemaphore ready_ = VK_NULL_HANDLE;
  VkImage picture_ = VK_NULL_HANDLE;
  VkDeviceMemory picture_memory_ = VK_NULL_HANDLE;
  VkExtent2D picture_extent_{};
  bool has_imgui_ = false;
  bool old_ = false;  // the window has changed since its images were made
};

}  // namespace coppice
