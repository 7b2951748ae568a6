#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coppice {

// Nothing here is waited for any longer.
inline constexpr std::chrono::seconds desktop_limit{90};

// Looks again and again until it is so; false if it is not so within the limit.
bool wait_until(const std::function<bool()>& is_so, std::chrono::seconds limit = desktop_limit);

// A process with its output in files; killed at the end if it is still there.
class Process {
 public:
  // `settings`: of the environment, NAME=VALUE.
  Process(const std::vector<std::string>& words, const std::string& name,
          const std::vector<std::string>& settings);
  ~Process();
  Process(const Process&) = delete;

  std::string out() const;
  std::string err() const;
  bool has_ended();
  void send(int signal) const;

  // The exit status, or nothing if it does not end within the limit; -1 for an end by a signal.
  std::optional<int> wait();

 private:
  std::string name_;
  int pid_ = -1;
  std::optional<int> status_;
};

// A display of its own, on which windows are opened and events are real. It has no window manager.
class Desktop {
 public:
  Desktop();

  // Why there is none, for a test that is skipped then; empty: there is one.
  const std::string& missing() const { return missing_; }

  std::vector<std::string> settings() const { return {"DISPLAY=" + display_, "XDG_SESSION_TYPE=x11"}; }

  // xdotool with these words; what it printed. Fails if it fails.
  std::string xdotool(const std::string& words) const;

  // What a window manager writes to a window that it minimises, or shows again.
  void set_minimised(const std::string& window, bool minimised) const;

  // The number of a window of that name that is to be seen; empty: there is none.
  std::string find(const std::string& name) const;

 private:
  std::string missing_, display_;
  std::optional<Process> server_;
};

}  // namespace coppice
