#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

#include "view/viewer.h"

namespace coppice {

namespace {

Viewer& viewer_of(GLFWwindow* window) { return *static_cast<Viewer*>(glfwGetWindowUserPointer(window)); }

// Before Dear ImGui's own, which hand on what they get.
void set_callbacks(GLFWwindow* window) {
  glfwSetKeyCallback(window, [](GLFWwindow* its, int key, int, int action, int) {
    if (action != GLFW_RELEASE) viewer_of(its).on_key(key, action == GLFW_REPEAT);
  });
  glfwSetCharCallback(
      window, [](GLFWwindow* its, unsigned int character) { viewer_of(its).on_character(character); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* its, int button, int action, int mods) {
    viewer_of(its).on_button(button, action == GLFW_PRESS, (mods & GLFW_MOD_SHIFT) != 0);
  });
  glfwSetCursorPosCallback(window,
                           [](GLFWwindow* its, double x, double y) { viewer_of(its).on_cursor(x, y); });
  glfwSetScrollCallback(window, [](GLFWwindow* its, double, double y) { viewer_of(its).on_scroll(y); });
  glfwSetDropCallback(window, [](GLFWwindow* its, int count, const char** paths) {
    if (count > 0) viewer_of(its).on_drop(paths[0]);
  });
}

}  // namespace

const Window& Viewer::with_input(const Window& window) {
  glfwSetWindowUserPointer(window.handle(), this);
  set_callbacks(window.handle());
  return window;
}

void Viewer::on_key(int key, bool repeats) {
  if (typed_keys_.has_field()) {
    if (!repeats) typed_keys_.add(key);
    return;
  }
  pressed_.push_back(key);
  switch (key) {
    case GLFW_KEY_ESCAPE:
      if (help_) {
        help_ = false;
      } else {
        glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
      }
      break;
    case GLFW_KEY_SPACE:
      plays_ = !plays_;
      break;
    case GLFW_KEY_PERIOD:
    case GLFW_KEY_COMMA:
      plays_ = false;
      seconds_ = std::max(seconds_ + (key == GLFW_KEY_PERIOD ? 1 : -1) / frames_per_second(), 0.0);
      break;
    case GLFW_KEY_P:
      request_.picture = true;
      break;
    case GLFW_KEY_C:
      request_.camera = true;
      break;
    case GLFW_KEY_R:
      request_.reset = true;
      break;
    case GLFW_KEY_B:
      request_.rebuild = true;
      break;
    case GLFW_KEY_F:
      flies_ = !flies_;
      break;
    case GLFW_KEY_F1:
      help_ = !help_;
      break;
    case GLFW_KEY_TAB:
      panes_ = !panes_;
      break;
    default:
      if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) asked_.show.show = static_cast<Show>(key - GLFW_KEY_1);
      break;
  }
}

// Wherever the layout of the keyboard has it.
void Viewer::on_character(unsigned int character) {
  if (character == '?' && !typed_keys_.has_field()) help_ = !help_;
}

void Viewer::on_button(int button, bool down, bool shift) {
  if (!down) {
    dragging_ = 0;
  } else if (!ImGui::GetIO().WantCaptureMouse) {
    dragging_ = button == GLFW_MOUSE_BUTTON_LEFT && !shift ? 1 : 2;
  }
}

void Viewer::on_cursor(double x, double y) {
  Drag* const drag = dragging_ == 1 ? &turns_ : dragging_ == 2 ? &pans_ : nullptr;
  if (drag) *drag = {drag->x + x - cursor_x_, drag->y + y - cursor_y_};
  cursor_x_ = x;
  cursor_y_ = y;
}

void Viewer::on_scroll(double steps) {
  if (!ImGui::GetIO().WantCaptureMouse) zooms_ += steps;
}

void Viewer::on_drop(const std::string& path) {
  asked_.scene.spec = typed_scene_ = path;
  asked_.scene.up = "y";
}

}  // namespace coppice
