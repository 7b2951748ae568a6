#pragma once

#include <vector>

#include "view/window.h"

namespace coppice {

// The images of a window that the user sees in turn. They are copied to and drawn to.
class Swapchain {
 public:
  explicit Swapchain(const Window& window);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;

  // For the window's size now; the device is idle.
  void remake();

  VkRenderPass render_pass() const { return render_pass_; }  // over what an image holds
  VkExtent2D extent() const { return extent_; }              // 0: there are no images
  std::uint32_t image_count() const { return static_cast<std::uint32_t>(images_.size()); }
  std::uint32_t least_image_count() const { return least_images_; }

  // The next image to draw to, once `ready` is signalled; false where the window has changed meanwhile.
  bool acquire(VkSemaphore ready, std::uint32_t& index);
  VkImage image(std::uint32_t index) const { return images_[index]; }
  VkFramebuffer framebuffer(std::uint32_t index) const { return framebuffers_[index]; }
  VkSemaphore drawn(std::uint32_t index) const { return drawn_[index]; }  // what `present` waits for
  bool present(std::uint32_t index);

 private:
  void choose_format();
  void make_render_pass();
  void free_images();

  const Window& window_;
  VkSurfaceFormatKHR format_{};
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::uint32_t least_images_ = 2;
  std::vector<VkImage> images_;
  std::vector<VkImageView> views_;
  std::vector<VkFramebuffer> framebuffers_;
  std::vector<VkSemaphore> drawn_;
};

}  // namespace coppice
