// The window, on a display of its own and driven by real events: what it shows is what `render` makes, and it
// stands whatever is done to it. Under the validation layers, of which a message ends it with status 1.
#include <csignal>
#include <nlohmann/json.hpp>

#include "support/view_window.h"

namespace coppice {
namespace {

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

// However the device's speed cuts the passes.
TEST_F(ViewWindow, RefinesWhatStandsStillToWhatRenderMakesOfAsManySamples) {
  OPEN_OR_SKIP(std::string("--spp 37 --size 160x120 --pictures picture --no-panes ") + COPPICE_SCENES +
               "/nook.json");
  expect_line("refined to 37 samples, error 0.");
  expect_same_as_render(1);
  desktop_->xdotool("mousemove 60 60 mousedown 1 mousemove 70 65 mouseup 1");
  EXPECT_TRUE(wait_until([&] { return times_shown("refined to 37 samples") == 2; })) << window_->out();
  expect_same_as_render(2);
  EXPECT_TRUE(pictures_[0] != pictures_[1]);
  key("3");  // normals have no samples
  expect_same_as_render(3);
  key("8");  // nor have boxes, which the kernels of colours show
  expect_same_as_render(4);
  key("1");
  EXPECT_TRUE(wait_until([&] { return times_shown("refined to 37 samples") == 3; })) << window_->out();
  expect_same_as_render(5);
  EXPECT_TRUE(pictures_[4] == pictures_[1]);
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
    // Letters that come before the field has seen the click are keys of the window, so it gets some frames'
    // time for it; and where it has not seen it then, it is tried again.
    EXPECT_TRUE(wait_until([&] {
      desktop_->xdotool("mousemove 100 30 click 1 sleep 0.5");
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

// Each goes down and up within a frame.
TEST_F(ViewWindow, NoKeyIsLostWhileFramesAreSlow) {
  OPEN_OR_SKIP("moving:20000 --size 480x320 --rebuild --paused --builder gpu-ploc");
  const auto cameras = [&] {
    std::vector<std::string> lines;
    std::istringstream out(window_->out());
    for (std::string line; std::getline(out, line);) {
      if (line.starts_with("render ")) lines.push_back(line);
    }
    return lines;
  };
  key("c");
  EXPECT_TRUE(wait_until([&] { return cameras().size() == 1; }));
  key("w");
  key("c");
  EXPECT_TRUE(wait_until([&] { return cameras().size() == 2; }));
  EXPECT_NE(cameras().front(), cameras().back()) << "it does not fly";
  EXPECT_TRUE(wait_until([&] {
    desktop_->xdotool("mousemove 400 300 click 1 sleep 1 mousemove 100 30 click 1 sleep 1");
    desktop_->xdotool("type --delay 1 scatter:70012");
    // GLFW takes two strokes of a key within a millisecond for one.
    desktop_->xdotool("key --delay 4 BackSpace BackSpace Return");
    return wait_until([&] { return shows("scene scatter:"); }, std::chrono::seconds(20));
  }));
  expect_line("scene scatter:700: 700 triangles");
  close();
}

// What is asked for meanwhile is there once it is seen again.
TEST_F(ViewWindow, IsMinimisedAndShownAgain) {
  OPEN_OR_SKIP("moving:500 --size 200x150 --pictures picture");
  const std::string id = id_of_window();
  desktop_->set_minimised(id, true);
  key("p");
  desktop_->xdotool("windowsize " + id + " 210 160");
  EXPECT_FALSE(wait_until([&] { return shows("wrote") || shows("size 210x160"); }, std::chrono::seconds(1)));
  desktop_->set_minimised(id, false);
  expect_line("size 210x160");
  expect_line("wrote picture-001.png");
  close();
}

// The frame that is under way is waited for, and no more.
TEST_F(ViewWindow, IsClosedWhileTheDeviceBuilds) {
  OPEN_OR_SKIP("moving:200000 --size 200x150 --rebuild --builder gpu-ploc");
  close();
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

TEST_F(ViewWindow, IsInterruptedWhileASceneIsOpenedAndBuilt) {
  ASSERT_TRUE(open("scatter:400000 --builder gd16 --size 200x150", false));
  wait_until([&] { return !id_of_window().empty() || window_->has_ended(); });
  if (window_->has_ended() && window_->err().find("cannot present") != std::string::npos)
    CANNOT_OPEN("the driver cannot present");
  window_->send(SIGINT);
  EXPECT_EQ(window_->wait(), 128 + SIGINT);
  EXPECT_EQ(without_notes(window_->err()), "coppice: interrupted\n");
}

TEST_F(ViewWindow, WarnsOnceOfATextureThatIsMissing) {
  write("wall.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd gone.png\n");
  write("wall.obj",
        "mtllib wall.mtl\nusemtl wall\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
        "f 1/1 2/2 3/3\n");
  OPEN_OR_SKIP("wall.obj --size 64x48 --rebuild");
  key("Escape");
  EXPECT_EQ(window_->wait(), 0) << window_->err();
  EXPECT_EQ(without_notes(window_->err()),
            "warning: gone.png: no such file, a checker takes its place as map_Kd of material 'wall'\n");
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
