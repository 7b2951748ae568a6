#include "view/screen.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <filesystem>

namespace coppice {

namespace {

constexpr std::uint64_t draw_limit_ns = 120'000'000'000;
constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr VkImageSubresourceRange all_of_image{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers layer_of_image{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

void check_imgui(VkResult result) { check_vulkan(result, "drawing"); }

// What a layout of an image is for.
struct ImageUse {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
  VkImageLayout layout;
};
constexpr ImageUse unused{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr ImageUse written{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr ImageUse read_from{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr ImageUse drawn_to{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};

void turn_into(VkCommandBuffer commands, VkImage image, const ImageUse& before, const ImageUse& after) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = before.stage;
  barrier.srcAccessMask = before.access;
  barrier.dstStageMask = after.stage;
  barrier.dstAccessMask = after.access;
  barrier.oldLayout = before.layout;
  barrier.newLayout = after.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = all_of_image;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

void memory_barrier(VkCommandBuffer commands, VkPipelineStageFlags2 from, VkAccessFlags2 written_by,
                    VkPipelineStageFlags2 to, VkAccessFlags2 read_by) {
  VkMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from;
  barrier.srcAccessMask = written_by;
  barrier.dstStageMask = to;
  barrier.dstAccessMask = read_by;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

std::uint32_t device_memory_type(VkPhysicalDevice physical, std::uint32_t allowed) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    if ((allowed >> type & 1) &&
        (memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
      return type;
  }
  throw DeviceError("the device has no memory for an image");
}

void begin_commands(VkCommandBuffer commands) {
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check_vulkan(vkBeginCommandBuffer(commands, &info), "a command buffer");
}

void set_style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.WindowPadding = {10, 10};
  style.ItemSpacing = {8, 6};
  style.Colors[ImGuiCol_WindowBg] = {0.07f, 0.08f, 0.09f, 0.86f};
}

}  // namespace

Screen::Screen(const Window& window) : window_(window), swapchain_(window) {
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = window.queue_family;
  check_vulkan(vkCreateCommandPool(window.device, &pool, nullptr, &pool_), "a command pool");
  VkCommandBufferAllocateInfo buffer{};
  buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  buffer.commandPool = pool_;
  buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  buffer.commandBufferCount = 1;
  check_vulkan(vkAllocateCommandBuffers(window.device, &buffer, &commands_), "a command buffer");
  VkFenceCreateInfo fence{};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  check_vulkan(vkCreateFence(window.device, &fence, nullptr, &done_), "a fence");
  VkSemaphoreCreateInfo semaphore{};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  check_vulkan(vkCreateSemaphore(window.device, &semaphore, nullptr, &ready_), "a semaphore");
  make_imgui();
}

Screen::~Screen() {
  vkDeviceWaitIdle(window_.device);
  if (has_imgui_) {
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
  }
  ImGui::DestroyContext();
  free_picture();
  vkDestroySemaphore(window_.device, ready_, nullptr);
  vkDestroyFence(window_.device, done_, nullptr);
  vkDestroyCommandPool(window_.device, pool_, nullptr);
  vkDestroyDescriptorPool(window_.device, descriptors_, nullptr);
}

void Screen::make_imgui() {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  info.maxSets = 4;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  check_vulkan(vkCreateDescriptorPool(window_.device, &info, nullptr, &descriptors_), "a descriptor pool");
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // panes come up where they are put
  ImGui::GetIO().LogFilename = nullptr;
  set_style();
  std::error_code error;
  if (std::filesystem::exists(font_file, error)) ImGui::GetIO().Fonts->AddFontFromFileTTF(font_file, 15);
  ImGui_ImplGlfw_InitForVulkan(window_.handle(), true);
  ImGui_ImplVulkan_InitInfo with{};
  with.Instance = window_.instance;
  with.PhysicalDevice = window_.physical;
  with.Device = window_.device;
  with.QueueFamily = window_.queue_family;
  with.Queue = window_.queue;
  with.DescriptorPool = descriptors_;
  with.MinImageCount = swapchain_.least_image_count();
  with.ImageCount = std::max(2u, swapchain_.image_count());
  with.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  with.CheckVkResultFn = check_imgui;
  ImGui_ImplVulkan_Init(&with, swapchain_.render_pass());
  has_imgui_ = true;
  begin_commands(commands_);
  ImGui_ImplVulkan_CreateFontsTexture(commands_);
  check_vulkan(vkEndCommandBuffer(commands_), "a command buffer");
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  check_vulkan(vkResetFences(window_.device, 1, &done_), "a fence");
  check_vulkan(vkQueueSubmit(window_.queue, 1, &submit, done_), "the letters");
  wait_for_last();
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void Screen::wait_for_last() {
  const VkResult result = vkWaitForFences(window_.device, 1, &done_, VK_TRUE, draw_limit_ns);
  if (result == VK_TIMEOUT) throw DeviceHung("the device did not draw the window within 120 s");
  check_vulkan(result, "drawing the window");
}

void Screen::wait() { check_vulkan(vkDeviceWaitIdle(window_.device), "the device"); }

void Screen::free_picture() {
  if (picture_) vkDestroyImage(window_.device, picture_, nullptr);
  if (picture_memory_) vkFreeMemory(window_.device, picture_memory_, nullptr);
  picture_ = VK_NULL_HANDLE;
  picture_memory_ = VK_NULL_HANDLE;
  picture_extent_ = {};
}

// Nothing is under way.
void Screen::make_picture(std::uint32_t width, std::uint32_t height) {
  if (picture_extent_.width == width && picture_extent_.height == height) return;
  free_picture();
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {width, height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check_vulkan(vkCreateImage(window_.device, &info, nullptr, &picture_), "the picture");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(window_.device, picture_, &needs);
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.allocationSize = needs.size;
  allocation.memoryTypeIndex = device_memory_type(window_.physical, needs.memoryTypeBits);
  check_vulkan(vkAllocateMemory(window_.device, &allocation, nullptr, &picture_memory_), "the picture");
  check_vulkan(vkBindImageMemory(window_.device, picture_, picture_memory_, 0), "the picture");
  picture_extent_ = {width, height};
}

void Screen::begin() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Screen::remake() {
  check_vulkan(vkDeviceWaitIdle(window_.device), "the device");
  swapchain_.remake();
  if (extent().width != 0) ImGui_ImplVulkan_SetMinImageCount(swapchain_.least_image_count());
  old_ = false;
}

bool Screen::show(const PicturePlace& picture) {
  ImGui::Render();
  const VkExtent2D size = window_.framebuffer();
  if (size.width == 0 || size.height == 0) return false;
  if (old_ || size.width != extent().width || size.height != extent().height) remake();
  if (extent().width == 0) return false;
  wait_for_last();
  std::uint32_t index = 0;
  if (!swapchain_.acquire(ready_, index)) {
    old_ = true;
    return false;
  }
  if (picture.buffer) make_picture(picture.width, picture.height);
  record(picture, index, ImGui::GetDrawData());
  const VkPipelineStageFlags wait_at = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  const VkSemaphore drawn = swapchain_.drawn(index);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.waitSemaphoreCount = 1;
  submit.pWaitSemaphores = &ready_;
  submit.pWaitDstStageMask = &wait_at;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  submit.signalSemaphoreCount = 1;
  submit.pSignalSemaphores = &drawn;
  check_vulkan(vkResetFences(window_.device, 1, &done_), "a fence");
  check_vulkan(vkQueueSubmit(window_.queue, 1, &submit, done_), "drawing the window");
  old_ = !swapchain_.present(index);
  return true;
}

void Screen::record(const PicturePlace& picture, std::uint32_t index, ImDrawData* data) {
  check_vulkan(vkResetCommandBuffer(commands_, 0), "a command buffer");
  begin_commands(commands_);
  const VkImage target = swapchain_.image(index);
  turn_into(commands_, target, unused, written);
  if (picture.buffer) {
    record_picture(picture, target);
  } else {
    const VkClearColorValue grey{{0.11f, 0.12f, 0.13f, 1}};
    vkCmdClearColorImage(commands_, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &grey, 1, &all_of_image);
  }
  turn_into(commands_, target, written, drawn_to);
  VkRenderPassBeginInfo pass{};
  pass.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  pass.renderPass = swapchain_.render_pass();
  pass.framebuffer = swapchain_.framebuffer(index);
  pass.renderArea = {{0, 0}, extent()};
  vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(data, commands_);
  vkCmdEndRenderPass(commands_);
  check_vulkan(vkEndCommandBuffer(commands_), "a command buffer");
}

// From the buffer that kernels have written, by an image of its size, over all of the target.
void Screen::record_picture(const PicturePlace& picture, VkImage target) {
  memory_barrier(commands_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                 VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  turn_into(commands_, picture_, unused, written);
  VkBufferImageCopy copy{};
  copy.bufferOffset = picture.offset;
  copy.imageSubresource = layer_of_image;
  copy.imageExtent = {picture.width, picture.height, 1};
  vkCmdCopyBufferToImage(commands_, picture.buffer, picture_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  turn_into(commands_, picture_, written, read_from);
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = layer_of_image;
  blit.srcOffsets[1] = {static_cast<std::int32_t>(picture.width), static_cast<std::int32_t>(picture.height),
                        1};
  blit.dstOffsets[1] = {static_cast<std::int32_t>(extent().width), static_cast<std::int32_t>(extent().height),
                        1};
  vkCmdBlitImage(commands_, picture_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
  // The next frame's kernels write where this one is read.
  memory_barrier(commands_, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                 0);
}

}  // namespace coppice
