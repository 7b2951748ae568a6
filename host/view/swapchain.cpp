#include "view/swapchain.h"

#include <algorithm>

namespace coppice {

namespace {

constexpr std::uint64_t acquire_limit_ns = 10'000'000'000;
constexpr VkImageUsageFlags swapchain_usage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

// The latest picture rather than a queue of them, where that can be had.
VkPresentModeKHR present_mode(const Window& window) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfacePresentModesKHR(window.physical, window.surface, &count, nullptr);
  std::vector<VkPresentModeKHR> modes(count);
  vkGetPhysicalDeviceSurfacePresentModesKHR(window.physical, window.surface, &count, modes.data());
  return std::ranges::find(modes, VK_PRESENT_MODE_MAILBOX_KHR) != modes.end() ? VK_PRESENT_MODE_MAILBOX_KHR
                                                                              : VK_PRESENT_MODE_FIFO_KHR;
}

}  // namespace

Swapchain::Swapchain(const Window& window) : window_(window) {
  choose_format();
  make_render_pass();
  remake();
}

Swapchain::~Swapchain() {
  free_images();
  if (swapchain_) vkDestroySwapchainKHR(window_.device, swapchain_, nullptr);
  if (render_pass_) vkDestroyRenderPass(window_.device, render_pass_, nullptr);
}

// Pictures hold codes of sRGB already, so that a format that encodes once more would show them wrong.
void Swapchain::choose_format() {
  std::uint32_t count = 0;
  check_vulkan(vkGetPhysicalDeviceSurfaceFormatsKHR(window_.physical, window_.surface, &count, nullptr),
               "the window's formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check_vulkan(
      vkGetPhysicalDeviceSurfaceFormatsKHR(window_.physical, window_.surface, &count, formats.data()),
      "the window's formats");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    const auto found = std::ranges::find(formats, wanted, &VkSurfaceFormatKHR::format);
    if (found == formats.end()) continue;
    format_ = *found;
    return;
  }
  throw DeviceError("no window: the device presents no images of 8 bits a channel here");
}

void Swapchain::make_render_pass() {
  VkAttachmentDescription colour{};
  colour.format = format_.format;
  colour.samples = VK_SAMPLE_COUNT_1_BIT;
  colour.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  colour.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  colour.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  colour.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  colour.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &colour;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  check_vulkan(vkCreateRenderPass(window_.device, &info, nullptr, &render_pass_), "the window's render pass");
}

void Swapchain::free_images() {
  for (const VkSemaphore semaphore : drawn_) vkDestroySemaphore(window_.device, semaphore, nullptr);
  for (const VkFramebuffer framebuffer : framebuffers_)
    vkDestroyFramebuffer(window_.device, framebuffer, nullptr);
  for (const VkImageView view : views_) vkDestroyImageView(window_.device, view, nullptr);
  drawn_.clear();
  framebuffers_.clear();
  views_.clear();
  images_.clear();
}

void Swapchain::remake() {
  free_images();
  VkSurfaceCapabilitiesKHR can;
  check_vulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(window_.physical, window_.surface, &can),
               "the window's surface");
  if ((can.supportedUsageFlags & swapchain_usage) != swapchain_usage)
    throw DeviceError("no window: images of this display cannot be copied to");
  const VkExtent2D asked = window_.framebuffer();
  extent_ = can.currentExtent.width != ~0u ? can.currentExtent : asked;
  extent_.width = std::clamp(extent_.width, can.minImageExtent.width, can.maxImageExtent.width);
  extent_.height = std::clamp(extent_.height, can.minImageExtent.height, can.maxImageExtent.height);
  if (asked.width == 0 || asked.height == 0) extent_ = {0, 0};
  if (extent_.width == 0 || extent_.height == 0) return;
  const std::uint32_t most = can.maxImageCount == 0 ? 16 : can.maxImageCount;
  least_images_ = std::max(2u, can.minImageCount);
  VkSwapchainCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = window_.surface;
  info.minImageCount = std::min(std::max(can.minImageCount + 1, 2u), most);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = swapchain_usage;
  info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = present_mode(window_);
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(window_.device, &info, nullptr, &made);
  if (swapchain_) vkDestroySwapchainKHR(window_.device, swapchain_, nullptr);
  swapchain_ = made;
  check_vulkan(result, "the window's images");
  std::uint32_t count = 0;
  check_vulkan(vkGetSwapchainImagesKHR(window_.device, swapchain_, &count, nullptr), "the window's images");
  images_.resize(count);
  check_vulkan(vkGetSwapchainImagesKHR(window_.device, swapchain_, &count, images_.data()),
               "the window's images");
  for (const VkImage image : images_) {
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check_vulkan(vkCreateImageView(window_.device, &view, nullptr, &views_.emplace_back()), "a view");
    VkFramebufferCreateInfo framebuffer{};
    framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    framebuffer.renderPass = render_pass_;
    framebuffer.attachmentCount = 1;
    framebuffer.pAttachments = &views_.back();
    framebuffer.width = extent_.width;
    framebuffer.height = extent_.height;
    framebuffer.layers = 1;
    check_vulkan(vkCreateFramebuffer(window_.device, &framebuffer, nullptr, &framebuffers_.emplace_back()),
                 "a framebuffer");
    VkSemaphoreCreateInfo semaphore{};
    semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    check_vulkan(vkCreateSemaphore(window_.device, &semaphore, nullptr, &drawn_.emplace_back()),
                 "a semaphore");
  }
}

bool Swapchain::acquire(VkSemaphore ready, std::uint32_t& index) {
  const VkResult result =
      vkAcquireNextImageKHR(window_.device, swapchain_, acquire_limit_ns, ready, VK_NULL_HANDLE, &index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return false;
  if (result == VK_TIMEOUT || result == VK_NOT_READY)
    throw DeviceHung("the display gave no image back within 10 s");
  check_vulkan(result, "the window's next image");
  return true;
}

bool Swapchain::present(std::uint32_t index) {
  VkPresentInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &drawn_[index];
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index;
  const VkResult result = vkQueuePresentKHR(window_.queue, &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) return false;
  check_vulkan(result, "presenting");
  return true;
}

}  // namespace coppice
