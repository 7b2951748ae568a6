// The command line in rough hands: killed, short of memory, with names that hold anything.
#include <signal.h>

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "support/command.h"

namespace coppice {
namespace {

// Whether the process is there and has not ended.
bool lives(pid_t process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() && text[name_end + 2] != 'Z';
}

pid_t first_child_of(pid_t process) {
  pid_t child = 0;
  std::ifstream("/proc/" + std::to_string(process) + "/task/" + std::to_string(process) + "/children") >>
      child;
  return child;
}

// Looks again and again; false after a minute, which is no time that anything here needs.
bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) return true;
    usleep(20000);
  }
  return false;
}

// compare with a row that takes as long as it may, in a process of its own.
pid_t start_compare(const char* limit_seconds) {
  const pid_t process = fork();
  if (process != 0) return process;
  for (const char* file : {"stdout.txt", "stderr.txt"}) {
    if (!std::freopen(file, "w", file[3] == 'o' ? stdout : stderr)) _exit(126);
  }
  execl(COPPICE_PROGRAM, "coppice", "compare", "scatter:200000", "--builders", "sbvh", "--runs", "10000",
        "--timeout", limit_seconds, nullptr);
  _exit(126);
}

TEST_F(Command, ARowDiesWithItsComparison) {
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    const pid_t compare = start_compare("600");
    pid_t child = 0;
    EXPECT_TRUE(comes_true([&] { return (child = first_child_of(compare)) > 0; }));
    kill(compare, signal);
    waitpid(compare, nullptr, 0);
    EXPECT_TRUE(child > 0 && comes_true([&] { return !lives(child); })) << "signal " << signal;
    if (child > 0 && lives(child)) kill(child, SIGKILL);
  }
}

TEST_F(Command, ARowEndsInTimeWhateverItsComparisonDoes) {
  const pid_t compare = start_compare("1");
  pid_t child = 0;
  EXPECT_TRUE(comes_true([&] { return (child = first_child_of(compare)) > 0; }));
  kill(compare, SIGSTOP);  // it cannot end the row any more
  EXPECT_TRUE(child > 0 && comes_true([&] { return !lives(child); }));
  kill(compare, SIGCONT);
  int status = 0;
  waitpid(compare, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_NE(read("stdout.txt").find("X (over 1 s)"), std::string::npos) << read("stdout.txt");
}

TEST_F(Command, NamesMayHoldAnything) {
  const std::string names[] = {"a&b<c>|`d\"e.obj", "\xFF\xC3.obj", "two\nlines.obj", "_*[x](y)_.obj"};
  for (const std::string& name : names) {
    write(name, read("one.obj"));
    const std::string quoted = "'" + name + "'";
    for (const std::string& arguments :
         {"build " + quoted + " --runs 1 --json -", "render " + quoted + " --size 8x8 -o p.png --json -",
          "lockstep " + quoted + " --size 8x8 --json -",
          "compare " + quoted + " --builders ploc --size 8x8 --json -"}) {
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
      EXPECT_TRUE(nlohmann::json::accept(outcome.out)) << arguments;
    }
  }
  write("\xFE", "");
  expect_refused("render '\xFE' -o out.png", 1, "no extension");
  expect_refused("render one.obj --builder '\xFE' -o out.png", 2, "--builder");
}

TEST_F(Command, ScenesThatNothingHoldsAreRefusedBeforeTheyAreMade) {
  expect_refused("build scatter:67107841", 1, "67107841");
  expect_refused("compare terrain:67107841 --builders lbvh", 1, "67107841");
  expect_refused("bench build --most 67107841", 1, "67107841");
  // In less memory than any of these scenes takes: they are refused, and by no allocation that failed.
  for (const char* arguments :
       {"build scatter:20000000 --builder lbvh", "build hard:points:20000000 --builder sah",
        "render terrain:20000000 --builder ploc --tracer cpu -o out.png"}) {
    const Outcome outcome = run_in(1000000, arguments);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("bytes of memory"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
}

}  // namespace
}  // namespace coppice
