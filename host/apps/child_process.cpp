#include "apps/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>

extern char** environ;

namespace coppice {

namespace {

pid_t spawn_self(const std::vector<std::string>& arguments, int output, int errors) {
  std::vector<std::string> words = {"coppice"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start a child process");
  return child;
}

// False if the limit comes before the end of the output.
bool read_all(int input, double limit_seconds, std::string& output) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_seconds));
  char piece[4096];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd wanted{input, POLLIN, 0};
    if (left <= 0) return false;
    const int ready = poll(&wanted, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    const ssize_t count = read(input, piece, sizeof piece);
    if (count <= 0) return true;
    output.append(piece, static_cast<std::size_t>(count));
  }
}

std::string last_line(std::FILE* file) {
  std::rewind(file);
  std::string line;
  char text[1024];
  while (std::fgets(text, sizeof text, file)) line = text;
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

}  // namespace

ChildResult run_self(const std::vector<std::string>& arguments, double limit_seconds) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), std::fclose);
  if (!errors) throw std::runtime_error("cannot open a temporary file");
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot open a pipe");
  ChildResult result;
  pid_t child = 0;
  try {
    child = spawn_self(arguments, ends[1], fileno(errors.get()));
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  result.timed_out = !read_all(ends[0], limit_seconds, result.output);
  close(ends[0]);
  if (result.timed_out) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.error = last_line(errors.get());
  return result;
}

}  // namespace coppice
