#include "support/desktop.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace coppice {

namespace {

std::string text_of_file(const std::string& name) {
  std::stringstream text;
  text << std::ifstream(name, std::ios::binary).rdbuf();
  return text.str();
}

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

bool wait_until(const std::function<bool()>& is_so, std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

Process::Process(const std::vector<std::string>& words, const std::string& name,
                 const std::vector<std::string>& settings)
    : name_(name) {
  std::vector<std::string> copies = words, set = settings;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string out = name + ".out", err = name + ".err";
  pid_ = fork();
  if (pid_ != 0) return;
  const int files[] = {open("/dev/null", O_RDONLY), open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600),
                       open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600)};
  for (int stream = 0; stream < 3; ++stream) dup2(files[stream], stream);
  for (std::string& setting : set) {
    if (setting.ends_with('=')) {
      unsetenv(setting.substr(0, setting.size() - 1).c_str());
    } else {
      putenv(setting.data());
    }
  }
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Process::~Process() {
  if (pid_ <= 0 || has_ended()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::string Process::out() const { return text_of_file(name_ + ".out"); }
std::string Process::err() const { return text_of_file(name_ + ".err"); }

void Process::send(int signal) const { kill(pid_, signal); }

bool Process::has_ended() {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_)
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return status_.has_value();
}

std::optional<int> Process::wait() {
  wait_until([&] { return has_ended(); });
  return status_;
}

Desktop::Desktop() {
  for (const char* const program : {"Xvfb", "xdotool"}) {
    if (!is_installed(program)) missing_ = std::string(program) + " is not installed";
  }
  if (!missing_.empty()) return;
  // It takes a display that is free and says which. Whenever its last client leaves it would start anew, and
  // the window that connects meanwhile would find none: xdotool comes and goes before there is a window.
  server_.emplace(std::vector<std::string>{"Xvfb", "-noreset", "-displayfd", "1", "-screen", "0",
                                           "1280x1024x24", "-nolisten", "tcp"},
                  "desktop", std::vector<std::string>{});
  wait_until([&] { return server_->out().ends_with('\n') || server_->has_ended(); });
  const std::string number = server_->out();
  if (number.ends_with('\n')) {
    display_ = ":" + number.substr(0, number.size() - 1);
  } else {
    missing_ = "Xvfb does not start: " + server_->err();
  }
}

std::string Desktop::find(const std::string& name) const {
  Process process({"timeout", "60", "xdotool", "search", "--onlyvisible", "--name", name}, "xdotool",
                  settings());
  process.wait();
  const std::string out = process.out();
  return out.substr(0, out.find('\n'));
}

std::string Desktop::xdotool(const std::string& words) const {
  std::vector<std::string> all = {"timeout", "60", "xdotool"};
  std::istringstream stream(words);
  for (std::string word; stream >> word;) all.push_back(word);
  Process process(all, "xdotool", settings());
  EXPECT_EQ(process.wait(), 0) << "xdotool " << words << ": " << process.err();
  return process.out();
}

// The property of ICCCM 4.1.3.1, whose type no tool can set. Of Xlib there is what GLFW loads, too.
void Desktop::set_minimised(const std::string& window, bool minimised) const {
  void* const xlib = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  ASSERT_TRUE(xlib) << dlerror();
  const auto function = [&]<class Function>(Function*& pointer, const char* name) {
    pointer = reinterpret_cast<Function*>(dlsym(xlib, name));
    ASSERT_TRUE(pointer) << name;
  };
  struct Display;
  Display* (*open)(const char* name) = nullptr;
  unsigned long (*atom_of)(Display*, const char* name, int only_if_exists) = nullptr;
  int (*change)(Display*, unsigned long window, unsigned long property, unsigned long type, int bits,
                int mode, const unsigned char* data, int count) = nullptr;
  int (*close)(Display*) = nullptr;
  function(open, "XOpenDisplay");
  function(atom_of, "XInternAtom");
  function(change, "XChangeProperty");
  function(close, "XCloseDisplay");
  Display* const display = open(display_.c_str());
  ASSERT_TRUE(display) << display_;
  const unsigned long state = atom_of(display, "WM_STATE", 0);
  const long value[] = {minimised ? 3 : 1, 0};  // iconic or normal, and no icon
  change(display, std::stoul(window), state, state, 32, 0, reinterpret_cast<const unsigned char*>(value), 2);
  close(display);
}

}  // namespace coppice
