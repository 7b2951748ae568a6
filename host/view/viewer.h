#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/camera_control.h"
#include "view/run_view.h"
#include "view/scene_job.h"
#include "view/screen.h"
#include "view/typed_keys.h"
#include "view/view_frames.h"
#include "view/window.h"

namespace coppice {

// For a shell.
std::string shell_word(const std::string& word);

// What the user has asked for; compared with what is shown.
struct ViewSettings {
  SceneOptions scene{};
  BuilderChoice builder{};
  WalkChoice walk{};
  ShowOptions show{};
  std::uint32_t divide = 1;         // the picture has so many times fewer pixels each way than the window
  bool rebuild = false;             // the tree, for every frame
  Update update = Update::rebuild;  // where triangles have moved
  bool draws_always = false;        // also where nothing has changed
};

// Whether both are made into the same tree, of the same scene.
bool same_tree(const ViewSettings& a, const ViewSettings& b);

// What the panes tell of the last frames.
struct ViewStatistics {
  struct Frame {
    double frame_ms, device_ms;
    std::vector<KernelGroup> groups;
    bool built;
  };
  static constexpr std::size_t kept = 160;
  std::deque<Frame> frames;
  std::vector<std::string> groups;  // of any frame, in order of appearance
  ViewedFrame last;
  ViewedTree tree;
  bool has_tree = false;
};

// The window with all that the user does to it. Input of GLFW comes by callbacks, and is done at the next
// frame.
class Viewer {
 public:
  Viewer(const ViewRun& run, const Note& note);
  ~Viewer();
  Viewer(const Viewer&) = delete;

  ViewReport run();

  // Input.
  void on_key(int key, bool repeats);
  void on_character(unsigned int character);
  void on_button(int button, bool down, bool shift);
  void on_cursor(double x, double y);
  void on_scroll(double steps);
  void on_drop(const std::string& path);

 private:
  struct Request {
    bool picture = false, camera = false, reset = false, rebuild = false;
  };
  struct Drag {
    double x = 0, y = 0;  // in pixels since the last frame
  };

  const Window& with_input(const Window& window);

  // viewer.cpp
  bool goes_on() const;
  void turn();
  bool show_picture();
  bool is_hidden() const;
  void wait_for_events();
  void take_scene();
  void start_scene();
  bool wants_other_levels() const;
  void move_camera(double seconds);
  void move_time(double seconds);
  bool moves() const;
  std::uint32_t samples_of_next_pass() const;
  bool is_refined(const ViewedFrame& frame) const;
  void submit_picture();
  void take_picture();
  Film film_at_time() const;
  bool camera_moves() const;
  std::vector<double> camera_now() const;
  void note_frame(const ViewedFrame& frame, double ms);

  // viewer_device.cpp
  void check_device();
  void wait_for_device() const;
  void remake_device(const char* reason);
  VkExtent2D wanted_size() const;  // of the picture
  void remake_frames();
  void make_frames(std::uint32_t width, std::uint32_t height);

  // viewer_answers.cpp
  void answer_requests();
  void write_picture();
  void copy_camera();
  std::string render_arguments() const;
  void say(const std::string& line) const;
  void complain(const std::string& line);
  ViewReport report();
  double frames_per_second() const;  // of the scene
  double scene_duration() const;

  // panes.cpp
  void panes();
  void scene_pane();
  void view_controls();
  void time_controls();
  void cost_pane();
  void kernel_chart();
  void tree_controls();
  void help_window();
  void messages();
  void legend();
  void box_overlay();
  std::string size_text(std::uint64_t bytes) const;

  ViewRun run_;
  Note note_;
  Window window_;
  std::optional<Screen> screen_;  // there, but for when the device is made anew
  std::optional<CheckedDevice> device_;
  SceneJob job_;
  std::unique_ptr<OpenedScene> opened_;
  std::unique_ptr<ViewFrames> frames_;
  std::optional<CameraControl> camera_;
  std::vector<double> camera_numbers_;  // of the picture; given ones until the camera is moved
  Film film_{};

  ViewSettings asked_, shown_;
  std::uint32_t width_ = 0, height_ = 0;  // of the picture
  VkExtent2D refused_{};                  // a size that there is no memory for: the picture keeps its own
  bool device_is_new_ = false;            // it has not shown a picture since the last one was lost
  bool picture_old_ = true;
  Request request_;
  Drag turns_, pans_;
  double zooms_ = 0;
  int dragging_ = 0;  // 0: nothing, 1: turning, 2: panning
  double cursor_x_ = 0, cursor_y_ = 0;
  TypedKeys typed_keys_;
  std::vector<int> pressed_;  // keys, since the last frame
  bool flies_ = false, plays_ = true, panes_ = true, help_ = false;
  double seconds_ = 0, drawn_seconds_ = 0;  // of the scene
  double seconds_a_sample_ = 0;             // of the host's clock, the last picture or pass
  std::chrono::steady_clock::time_point last_turn_, last_description_, submit_time_;
  std::string typed_scene_, complaint_;
  ViewStatistics statistics_;
  std::vector<double> frame_ms_, device_ms_;
  std::uint64_t presented_ = 0, drawn_ = 0;  // frames, and pictures in them
  std::vector<Node> boxes_;                  // of the tree that is shown as boxes
};

}  // namespace coppice
