#pragma once

#include <deque>

struct GLFWwindow;

namespace coppice {

// Keys for text fields. Dear ImGui sees which keys are down when a frame begins: one that goes down and up
// between two frames it misses, and of several that edit text it takes one. So each is shown to it as down in
// a frame of its own, in the order in which they came, and as up before it comes again.
class TypedKeys {
 public:
  // A key has gone down that a text field may want. Letters, which come as characters, are left out.
  void add(int key);
  bool any_left() const { return !keys_.empty(); }

  // Whether what is typed goes to a text field, as of the end of the last frame. Dear ImGui's WantTextInput
  // comes a frame later, when letters have gone to the field already.
  bool has_field() const { return has_field_; }

  // Around what Dear ImGui makes of a frame.
  void begin_frame();
  void end_frame(GLFWwindow* window);

 private:
  std::deque<int> keys_, changed_;
  bool has_field_ = false;
};

}  // namespace coppice
