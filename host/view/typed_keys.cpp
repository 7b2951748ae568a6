#include "view/typed_keys.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

namespace coppice {

void TypedKeys::add(int key) {
  constexpr std::size_t most = 64;  // of a window that has stood still for long
  const bool edits = (key >= GLFW_KEY_ESCAPE && key <= GLFW_KEY_END) || key == GLFW_KEY_KP_ENTER;
  if (edits && keys_.size() < most) keys_.push_back(key);
}

void TypedKeys::begin_frame() {
  changed_ = keys_;
  if (keys_.empty()) return;
  ImGuiIO& io = ImGui::GetIO();
  for (const int key : keys_) io.KeysDown[key] = false;
  const int key = keys_.front();
  if (io.KeysDownDuration[key] >= 0) return;  // in the frame before it was down
  io.KeysDown[key] = true;
  keys_.pop_front();
}

void TypedKeys::end_frame(GLFWwindow* window) {
  for (const int key : changed_) ImGui::GetIO().KeysDown[key] = glfwGetKey(window, key) == GLFW_PRESS;
  changed_.clear();
  has_field_ = ImGui::IsAnyItemActive() && ImGui::GetCurrentContext()->WantTextInputNextFrame == 1;
}

}  // namespace coppice
