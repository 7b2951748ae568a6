// The window where the device fails: a layer of Vulkan's loader (layer/failing_layer.cpp) stands in for the
// driver that was reset, hangs or has no memory left.
#include "support/view_window.h"

namespace coppice {
namespace {

class FailingDevice : public ViewWindow {
 protected:
  static std::vector<std::string> with_layer(const std::string& setting = "COPPICE_DEVICE_FAILS=fails") {
    const char* const others = std::getenv("VK_ADD_LAYER_PATH");
    return {"VK_INSTANCE_LAYERS=VK_LAYER_COPPICE_failing",
            "VK_ADD_LAYER_PATH=" COPPICE_TEST_LAYER + (others ? ":" + std::string(others) : ""), setting};
  }

  // Lines of stderr, without those of the driver and the machine.
  std::ptrdiff_t lines() const { return std::ranges::count(without_notes(window_->err()), '\n'); }

  void expect_picture() {
    key("p");
    expect_line("wrote picture-001.png");
  }

  void expect_complaint(const std::string& text) {
    EXPECT_TRUE(wait_until([&] { return says(text) || window_->has_ended(); }));
    EXPECT_TRUE(says(text)) << text << " is not in " << window_->err();
  }
  bool says(const std::string& text) const { return window_->err().find(text) != std::string::npos; }
};

#define OPEN_WITH_LAYER(arguments, ...)                \
  if (!open(arguments, true, with_layer(__VA_ARGS__))) \
  CANNOT_OPEN("the driver cannot present: " + window_->err())

TEST_F(FailingDevice, OneThatIsLostIsMadeAnewAndShowsTheSame) {
  OPEN_WITH_LAYER("terrain:500 --size 200x150 --pictures picture --rebuild");
  desktop_->xdotool("mousemove 100 100 mousedown 1 mousemove 130 110 mouseup 1");
  expect_same_as_render(1);
  for (int time = 2; time <= 3; ++time) {
    write("fails", "lost");
    EXPECT_TRUE(wait_until([&] { return !fs::exists("fails"); }));
    expect_same_as_render(time);
  }
  EXPECT_EQ(pictures_[0], pictures_[1]);
  EXPECT_EQ(pictures_[0], pictures_[2]);
  key("Escape");
  EXPECT_EQ(window_->wait(), 0);
  EXPECT_EQ(lines(), 2) << window_->err();
  EXPECT_TRUE(says(": the device was lost; it is made anew\n")) << window_->err();
}

TEST_F(FailingDevice, OneThatIsLostAgainAtOnceEndsTheWindow) {
  OPEN_WITH_LAYER("one.obj --size 200x150 --pictures picture --rebuild");
  expect_picture();
  write("fails", "lost all");
  EXPECT_EQ(window_->wait(), 1);
  EXPECT_EQ(lines(), 2) << window_->err();
  EXPECT_TRUE(says(": the device was lost\n")) << window_->err();
}

// Nothing waits for it again when the window ends.
TEST_F(FailingDevice, OneThatHangsEndsTheWindow) {
  OPEN_WITH_LAYER("one.obj --size 200x150 --pictures picture --rebuild");
  expect_picture();
  write("fails", "hangs");
  EXPECT_EQ(window_->wait(), 1);
  EXPECT_EQ(lines(), 1) << window_->err();
  EXPECT_TRUE(says("did not finish within") || says("did not draw the window within")) << window_->err();
}

// Through a binary tree rays lie in memory.
TEST_F(FailingDevice, APictureTooLargeForItsMemoryKeepsTheSizeThatItHad) {
  OPEN_WITH_LAYER("terrain:500 --size 200x150 --pictures picture --rebuild --tree binary",
                  "COPPICE_LARGEST_ALLOCATION=16777216");
  const std::string id = id_of_window();
  desktop_->xdotool("windowsize " + id + " 1200 1000");
  expect_complaint("; the picture stays 200x150, scaled\n");
  EXPECT_TRUE(says("coppice: out of memory: the device has no ")) << window_->err();
  desktop_->xdotool("windowfocus " + id);
  expect_same_as_render(1);
  EXPECT_EQ(lines(), 1) << window_->err();  // it is not tried again and again
  desktop_->xdotool("windowsize " + id + " 300 200");
  expect_line("size 300x200");
  expect_same_as_render(2);
  key("Escape");
  EXPECT_EQ(window_->wait(), 0);
  EXPECT_EQ(lines(), 1) << window_->err();
}

}  // namespace
}  // namespace coppice
