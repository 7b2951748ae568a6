#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "support/command.h"
#include "support/desktop.h"

namespace coppice {

// test.sh says so where it has installed all that a window takes and knows the driver: a test that opens none
// has failed there.
inline bool has_to_open() { return std::getenv("COPPICE_TEST_WINDOW") != nullptr; }

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
  // `settings`: of the environment, beside those of the desktop.
  bool open(const std::string& arguments, bool waits = true, std::vector<std::string> settings = {}) {
    for (const std::string& setting : desktop_->settings()) settings.push_back(setting);
    std::vector<std::string> words = {COPPICE_PROGRAM, "view", "--validate"};
    if (arguments.find("--spp") == std::string::npos) words.insert(words.end(), {"--spp", "1"});
    std::istringstream stream(arguments);
    for (std::string word; stream >> word;) words.push_back(word);
    window_.emplace(words, "window", settings);
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
  // How often.
  int times_shown(const std::string& text) const {
    const std::string out = window_->out();
    int times = 0;
    for (std::size_t at = out.find(text); at != std::string::npos; at = out.find(text, at + 1)) ++times;
    return times;
  }
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

}  // namespace coppice
