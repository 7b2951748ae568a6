// The window, on a display of its own and driven by real events: what it shows is what `render` makes, and it
// stands whatever is done to it. Under the validation layers, of which a message ends it with status 1.
#include <nlohmann/json.hpp>

#include "support/command.h"
#include "support/desktop.h"

namespace coppice {
namespace {

// test.sh says so where it has installed all that a window takes and knows the driver: a test that opens none
// has failed there.
bool has_to_open() { return std::getenv("COPPICE_TEST_WINDOW") != nullptr; }

#define CANNOT_OPEN(reason)     \
  do {                          \
    if (has_to_open())          \
      FAIL() << (reason);       \
    else                        \
      GTEST_SKIP() << (reason); \
  } while (false)

class ViewWindow : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    if (!fs::exists(fs::path(COPPICE_PROGRAM).parent_path() / "coppice-view"))
      CANNOT_OPEN("built without a window");
    desktop_.emplace();
    if (!desktop_->missing().empty()) CANNOT_OPEN(desktop_->missing());
  }

  void TearDown() override {
    window_.reset();
    desktop_.reset();
    Command::TearDown();
  }

  // Opens it and waits for its first picture. False where the driver cannot present: the test is skipped.
  bool open(const std::string& arguments, bool waits = true) {
    std::vector<std::string> words = {COPPICE_PROGRAM, "view", "--validate"};
    std::istringstream stream(arguments);
    for (std::string word; stream >> word;) words.push_back(word);
    window_.emplace(words, "window", desktop_->settings());
    if (!waits) return true;
    if (wait_until([&] { return shows("size ") || window_->has_ended(); }) && shows("size ")) {
      // Before it is shown and has the focus, keys would go elsewhere.
      const std::string id = id_of_window();
      desktop_->xdotool("windowfocus --sync " + id);
      return true;
    }
    if (window_->err().find("cannot present") != std::string::npos) return false;
    ADD_FAILURE() << window_->out() << window_->err();
    return true;
  }

  std::string id_of_window() {
    std::string id;
    wait_until([&] {
      id = desktop_->find("Coppice");
      return !id.empty();
    });
    return id;
  }

  bool shows(const std::string& text) const { return window_->out().find(text) != std::string::npos; }
  void expect_line(const std::string& text) {
    EXPECT_TRUE(wait_until([&] { return shows(text) || window_->has_ended(); }));
    EXPECT_TRUE(shows(text)) << text << " is not in " << window_->out() << window_->err();
  }

  void key(const std::string& name) { desktop_->xdotool("key --delay 0 " + name); }

  // Writes the picture, and lets `render` make it by the arguments that the window gives.
  void expect_same_as_render(int number) {
    const std::string name =
        "picture-0" + std::string(number < 10 ? "0" : "") + std::to_string(number) + ".png";
    key("p");
    expect_line("wrote " + name);
    key("c");
    std::string arguments;
    EXPECT_TRUE(wait_until([&] {
      const std::string out = window_->out();
      const std::size_t wrote = out.find("wrote " + name), begin = out.find("\nrender ", wrote);
      if (begin == std::string::npos || out.find('\n', begin + 1) == std::string::npos) return false;
      arguments = out.substr(begin + 1, out.find('\n', begin + 1) - begin - 1);
      return true;
    })) << window_->out();
    const Outcome outcome = run(arguments + " -o rendered.png");
    EXPECT_EQ(outcome.status, 0) << arguments << '\n' << outcome.err;
    EXPECT_TRUE(read(name) == read("rendered.png") && !read(name).empty()) << arguments;
    pictures_.push_back(read(name));
  }

  void close() {
    key("Escape");
    EXPECT_EQ(window_->wait(), 0) << window_->err();
    EXPECT_EQ(without_notes(window_->err()), "");
  }

  std::optional<Desktop> desktop_;
  std::optional<Process> window_;
  std::vector<std::string> pictures_;
};

#define OPEN_OR_SKIP(arguments) \
  if (!open(arguments)) CANNOT_OPEN("the driver cannot present: " + window_->err())

TEST_F(ViewWindow, ShowsWhatRenderMakesFromWhereverOneLooks) {
  OPEN_OR_SKIP(
      "terrain:3000 --size 320x240 --pictures picture --no-panes --builder gpu-ploc --show clusters --round "
      "3");
  expect_same_as_render(1);
  key("1");
  desktop_->xdotool("mousemove 100 100 mousedown 1 mousemove 130 110 mousemove 160 90 mouseup 1");
  desktop_->xdotool("mousemove 100 100 mousedown 3 mousemove 90 120 mouseup 3 click 4 click 4 click 5");
  expect_same_as_render(2);
  key("f");
  desktop_->xdotool("mousemove 100 100 mousedown 1 mousemove 95 120 mouseup 1 click 4");
  expect_same_as_render(3);
  int pictures = 3;
  for (const char* view : {"2", "3", "4", "5", "6", "8"}) {
    key(view);
    expect_same_as_render(++pictures);
  }
  for (std::size_t i = 0; i < pictures_.size(); ++i)
    EXPECT_EQ(std::ranges::count(pictures_, pictures_[i]), 1) << i;
  close();
}

// Two levels, in every view.
TEST_F(ViewWindow, ShowsInstancesAsRenderDoes) {
  OPEN_OR_SKIP(
      "instances:90 --size 160x120 --pictures picture --no-panes --paused --builder gpu-ploc --show clusters "
      "--round 2");
  int pictures = 0;
  for (const char* view : {"1", "2", "3", "4", "5", "6", "7", "8", "9"}) {
    key(view);
    expect_same_as_render(++pictures);
  }
  for (std::size_t i = 0; i < pictures_.size(); ++i)
    EXPECT_EQ(std::ranges::count(pictures_, pictures_[i]), 1) << i;
  close();
}

TEST_F(ViewWindow, TakesAnySizeAndIsHiddenAndShown) {
  OPEN_OR_SKIP("terrain:500 --size 200x150 --pictures picture --rebuild");
  const std::string id = id_of_window();
  desktop_->xdotool("windowsize " + id + " 333 77");
  expect_line("size 333x77");
  desktop_->xdotool("windowsize " + id + " 1 1");
  expect_line("size 1x1");
  desktop_->xdotool("windowsize " + id + " 640 480");
  expect_line("size 640x480");
  desktop_->xdotool("windowunmap " + id);
  desktop_->xdotool("windowmap " + id);
  desktop_->xdotool("windowfocus " + id);
  EXPECT_TRUE(wait_until([&] { return desktop_->xdotool("getwindowfocus").starts_with(id); }));
  expect_same_as_render(1);
  close();
}

TEST_F(ViewWindow, AnotherSceneIsTypedAndABadOneIsNamed) {
  write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  OPEN_OR_SKIP("terrain:500 --size 640x480 --pictures picture");
  const auto type = [&](const std::string& name, const std::function<bool()>& is_there) {
    // Letters are lost that come before the field has seen the click, so it is tried again.
    EXPECT_TRUE(wait_until([&] {
      desktop_->xdotool("mousemove 100 30 click 1");
      desktop_->xdotool("type --delay 1 " + name);
      desktop_->xdotool("key Return");
      return wait_until(is_there, std::chrono::seconds(2));
    })) << name
        << ": " << window_->out() << window_->err();
  };
  type("one.obj", [&] { return shows("scene one.obj: 1 triangles"); });
  type("bad.obj", [&] { return window_->err().find("bad.obj:4") != std::string::npos; });
  type("scatter:700", [&] { return shows("scene scatter:700: 700 triangles"); });
  desktop_->xdotool("mousemove 320 400 click 1");
  expect_same_as_render(1);
  key("Escape");
  EXPECT_EQ(window_->wait(), 0);
  EXPECT_EQ(std::ranges::count(without_notes(window_->err()), '\n'), 1) << window_->err();
}

// The host's builder and the reader of the scene go on in a thread of their own, which is most often not done
// when the key comes.
TEST_F(ViewWindow, IsClosedWhileASceneIsOpenedAndBuilt) {
  ASSERT_TRUE(open("scatter:400000 --builder gd16 --size 200x150", false));
  std::string id;
  wait_until([&] { return !(id = id_of_window()).empty() || window_->has_ended(); });
  if (window_->has_ended() && window_->err().find("cannot present") != std::string::npos)
    CANNOT_OPEN("the driver cannot present");
  desktop_->xdotool("windowfocus " + id);
  key("Escape");
  EXPECT_EQ(window_->wait(), 0) << window_->err();
}

TEST_F(ViewWindow, FramesOfAMovingSceneAreThoseOfAnimateHoweverItsTreesAreMade) {
  const Outcome animated = run("animate moving:2000 --size 160x120 --frames 4 --json animate.json");
  ASSERT_EQ(animated.status, 0) << animated.err;
  const auto hashes = nlohmann::json::parse(read("animate.json"))["frame_hashes"];
  EXPECT_NE(hashes.back(), hashes.front());
  for (const char* update : {"rebuild", "refit", "auto"}) {
    window_.emplace(
        std::vector<std::string>{COPPICE_PROGRAM, "view", "--validate", "moving:2000", "--size", "160x120",
                                 "--frames", "4", "--json", "view.json", "--update", update},
        "window", desktop_->settings());
    ASSERT_TRUE(window_->wait());
    if (window_->err().find("cannot present") != std::string::npos) CANNOT_OPEN("the driver cannot present");
    ASSERT_EQ(window_->wait(), 0) << window_->err();
    const auto view = nlohmann::json::parse(read("view.json"));
    EXPECT_EQ(view["frames"], 4);
    EXPECT_EQ(view["image_hash"], hashes.back()) << update;
  }
}

TEST_F(ViewWindow, WithoutADisplayOneLineSaysSo) {
  Process none({COPPICE_PROGRAM, "view", "one.obj"}, "none", {"DISPLAY=", "WAYLAND_DISPLAY="});
  EXPECT_EQ(none.wait(), 1);
  EXPECT_NE(none.err().find("no window: "), std::string::npos) << none.err();
  EXPECT_EQ(std::ranges::count(without_notes(none.err()), '\n'), 1) << none.err();
  window_.emplace(std::vector<std::string>{COPPICE_PROGRAM, "view", "missing.obj"}, "window",
                  desktop_->settings());
  EXPECT_EQ(window_->wait(), 1);
  EXPECT_EQ(std::ranges::count(without_notes(window_->err()), '\n'), 1) << window_->err();
}

}  // namespace
}  // namespace coppice
