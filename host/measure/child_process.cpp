#include "measure/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace coppice {

namespace {

constexpr int could_not_start = 127;

// How much later than the child's own timer the parent ends it, should the timer not have done so.
constexpr double grace_seconds = 2;

itimerval timer_of(double seconds) {
  const double whole = std::floor(seconds);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - whole) * 1e6);
  if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0) timer.it_value.tv_usec = 1;
  return timer;
}

// Between fork and exec, so only calls that are safe after a fork of a process with threads. Timer,
// parent-death signal and group stay with the program that exec starts; a blocked or ignored SIGALRM would,
// too.
[[noreturn]] void become_child(const char* file, char* const* argv, pid_t parent, int output, int errors,
                               const itimerval& timer) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(could_not_start);  // it died before the call above
  signal(SIGALRM, SIG_DFL);
  sigset_t alarm_only;
  sigemptyset(&alarm_only);
  sigaddset(&alarm_only, SIGALRM);
  sigprocmask(SIG_UNBLOCK, &alarm_only, nullptr);
  setitimer(ITIMER_REAL, &timer, nullptr);
  if (dup2(output, STDOUT_FILENO) >= 0 && dup2(errors, STDERR_FILENO) >= 0) execvp(file, argv);
  _exit(could_not_start);
}

// `file`: a path, or a name that is looked for in PATH.
pid_t start_child(const char* file, const std::string& name, const std::vector<std::string>& arguments,
                  int output, int errors, double limit_seconds) {
  std::vector<std::string> words = {name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const itimerval timer = timer_of(limit_seconds);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become_child(file, argv.data(), parent, output, errors, timer);
  if (child < 0)
    throw std::runtime_error(std::string("cannot start a child process: ") + std::strerror(errno));
  setpgid(child, child);  // here too: whoever comes first
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
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    output.append(piece, static_cast<std::size_t>(count));
  }
}

void read_errors(std::FILE* file, ChildResult& result) {
  std::rewind(file);
  std::string text;
  char piece[4096];
  while (const std::size_t count = std::fread(piece, 1, sizeof piece, file)) text.append(piece, count);
  std::string last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("note: ")) result.notes.push_back(line);
    if (!line.empty()) last = line;
  }
  if (result.error.empty()) result.error = last;
  if (result.error.empty() && result.exit_status == could_not_start) result.error = "could not be started";
}

// Reaps the child. What it may have started itself ends before: until then the group's number is no other's.
void reap(pid_t child, ChildResult& result) {
  siginfo_t ignored;
  while (waitid(P_PID, static_cast<id_t>(child), &ignored, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  kill(-child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (WIFSIGNALED(status)) {
    result.timed_out = result.timed_out || WTERMSIG(status) == SIGALRM;
    result.error = std::string("ended by a signal: ") + strsignal(WTERMSIG(status));
  }
}

ChildResult run_child(const char* file, const std::string& name, const std::vector<std::string>& arguments,
                      double limit_seconds) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), std::fclose);
  if (!errors) throw std::runtime_error("cannot open a temporary file");
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot open a pipe");
  ChildResult result;
  pid_t child = 0;
  try {
    child = start_child(file, name, arguments, ends[1], fileno(errors.get()), limit_seconds);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  result.timed_out = !read_all(ends[0], limit_seconds + grace_seconds, result.output);
  close(ends[0]);
  if (result.timed_out) kill(-child, SIGKILL);
  reap(child, result);
  read_errors(errors.get(), result);
  result.could_not_start = result.exit_status == could_not_start;
  return result;
}

}  // namespace

ChildResult run_self(const std::vector<std::string>& arguments, double limit_seconds) {
  return run_child("/proc/self/exe", "coppice", arguments, limit_seconds);
}

ChildResult run_program(const std::string& name, const std::vector<std::string>& arguments,
                        double limit_seconds) {
  return run_child(name.c_str(), name, arguments, limit_seconds);
}

}  // namespace coppice
