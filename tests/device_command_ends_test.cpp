// How a run of the program ends that cannot go on: on a signal, without memory, without a loader; and what it
// says of a device without timestamps.
#include <fcntl.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/command.h"

namespace coppice {
namespace {

class CommandEnds : public Command {
 protected:
  static pid_t start(const std::vector<const char*>& arguments) {
    const pid_t child = fork();
    if (child != 0) return child;
    for (const auto& [stream, file] : {std::pair{STDOUT_FILENO, "stdout.txt"}, {STDERR_FILENO, "stderr.txt"}})
      dup2(open(file, O_WRONLY | O_CREAT | O_TRUNC, 0644), stream);
    alarm(120);  // kept by the program: nothing outlives the test
    std::vector<char*> argv = {const_cast<char*>(COPPICE_PROGRAM)};
    for (const char* argument : arguments) argv.push_back(const_cast<char*>(argument));
    argv.push_back(nullptr);
    execv(COPPICE_PROGRAM, argv.data());
    _exit(127);
  }

  // Whether the process has ended or has a handler for the signal, by /proc.
  static bool hears(pid_t child, int signal) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    std::string word;
    while (status >> word && word != "SigCgt:") {
      if (word == "State:" && status >> word && word == "Z") return true;
    }
    return status >> word && (std::stoull(word, nullptr, 16) >> (signal - 1) & 1);
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }
};

TEST_F(CommandEnds, ASignalWhileTracingEndsItWithALineAndNoFile) {
  const std::vector<std::string> before = files();
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const auto& [tracer, refines] : {std::pair("gpu", false), {"cpu", false}, {"gpu", true}}) {
      SCOPED_TRACE(std::to_string(signal) + " " + tracer + (refines ? ", refined" : ""));
      std::vector<const char*> arguments = {"render", "one.obj", "--size",   "2000x2000",
                                            "--spp",  "65536",   "--tracer", tracer,
                                            "-o",     "out.png", "--json",   "out.json"};
      if (refines) arguments.insert(arguments.end(), {"--error", "1e-30"});
      const pid_t child = start(arguments);
      while (!hears(child, signal)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      kill(child, signal);
      int status = 0;
      ASSERT_EQ(waitpid(child, &status, 0), child);
      ASSERT_TRUE(WIFEXITED(status)) << status;
      EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
      EXPECT_EQ(without_notes(read("stderr.txt")), "coppice: interrupted\n");
      EXPECT_EQ(read("stdout.txt"), "");
      fs::remove("stdout.txt");
      fs::remove("stderr.txt");
      EXPECT_EQ(files(), before);
    }
  }
}

TEST_F(CommandEnds, WithoutMemoryForTheDeviceItSaysHowMuchItWanted) {
  for (const char* arguments : {"build scatter:2000000 --runs 1", "render scatter:2000000 -o out.png"}) {
    const Outcome outcome = run_in(1000000, arguments);
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("memory"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(" bytes"), std::string::npos) << outcome.err;
  }
}

// Drivers crash or hang where they run out of address space while they load.
TEST_F(CommandEnds, WithoutMemoryForTheDriverItSaysHowMuchItWanted) {
  for (const std::uint64_t kilobytes : {100000, 200000, 400000, 500000, 600000, 650000}) {
    for (const char* arguments : {"build terrain:500 --runs 1", "devices"}) {
      const Outcome outcome = run_in(kilobytes, arguments);
      EXPECT_EQ(outcome.status, 1) << kilobytes << " " << arguments;
      EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
      EXPECT_NE(outcome.err.find(" bytes"), std::string::npos) << outcome.err;
    }
  }
}

TEST_F(CommandEnds, WithoutALoaderItSaysSoInOneLine) {
  fs::create_directory("nothing");
  for (const char* name : {"nothing/libvulkan.so", "nothing/libvulkan.so.1"}) write(name, "");
  const Outcome outcome = run_with("LD_LIBRARY_PATH=$PWD/nothing ", "render one.obj -o out.png");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("ulkan"), std::string::npos) << outcome.err;
}

TEST_F(CommandEnds, WithoutTimestampsTimesAreTheHostsAndKernelsHaveNone) {
  const std::string without = "COPPICE_NO_TIMESTAMPS=1 ";
  const Outcome outcome =
      run_with(without, "render terrain:500 --size 64x48 --tree wide --kernels -o out.png --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t said = outcome.err.find("no timestamps");
  EXPECT_NE(said, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("no timestamps", said + 1), std::string::npos) << outcome.err;
  EXPECT_EQ(without_notes(outcome.err), "");
  EXPECT_EQ(outcome.out.find("inf"), std::string::npos) << outcome.out;
  const auto render = nlohmann::json::parse(read("out.json"));
  for (const auto& json : {render, render["build"]}) {
    for (const char* name : {"kernels", "timed_ms", "copy_gb_per_s"})
      EXPECT_TRUE(json[name].is_null()) << name;
  }
  EXPECT_GT(render["trace_ms"], 0);
  EXPECT_GT(render["wide_ms"], 0);
  EXPECT_GT(render["build"]["build_ms"], 0);
  EXPECT_NEAR(render["mrays_per_s"], 64 * 48 / render["trace_ms"].get<double>() / 1000, 1e-9);
  for (const char* arguments :
       {"sort --most 1024 --only sort_keys_32", "scan --most 1024", "trace terrain:500 --size 32x24",
        "instances --most 200 --size 32x24", "build --most 3000 --builder gpu-ploc"}) {
    const Outcome bench = run_with(without, std::string("bench ") + arguments + " --runs 2 --json -");
    ASSERT_EQ(bench.status, 0) << arguments << ": " << bench.err;
    const auto report = nlohmann::json::parse(bench.out);
    EXPECT_FALSE(report["rows"].empty()) << arguments;
    for (const auto& row : report["rows"]) {
      EXPECT_GT(row["ms"], 0) << arguments;
      EXPECT_GT(row["millions_per_s"], 0) << arguments;
    }
  }
  EXPECT_EQ(run_with(without, "bench ploc --most 5000 --runs 2").status, 1);
}

// The picture is traced twice, for its time and for its kernels; each is traced in submits of its own cut.
TEST_F(CommandEnds, KernelsAndTraceEventsCoverAllSubmitsOfALongTrace) {
  const Outcome outcome =
      run("render terrain:500 --size 640x480 --spp 9 --tree binary --validate -o out.png --json out.json "
          "--trace-events events.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto render = nlohmann::json::parse(read("out.json"));
  std::map<std::string, double> events_ms, kernels_ms;
  std::map<std::string, std::uint64_t> bytes, events;
  const auto written = nlohmann::json::parse(read("events.json"));
  for (const auto& event : written["traceEvents"]) {
    events_ms[event["name"]] += event["dur"].get<double>() / 1000;
    ++events[event["name"]];
  }
  for (const auto& json : {render, render["build"]}) {
    for (const auto& kernel : json["kernels"]) {
      kernels_ms[kernel["name"]] += kernel["ms"].get<double>();
      bytes[kernel["name"]] += kernel["bytes"].get<std::uint64_t>();
      events[kernel["name"]] -= kernel["dispatches"].get<std::uint64_t>();
    }
  }
  ASSERT_EQ(events_ms.size(), kernels_ms.size());
  for (const auto& [name, ms] : kernels_ms) {
    EXPECT_NEAR(events_ms[name], ms, 1e-6) << name;
    EXPECT_EQ(events[name], 0u) << name;
  }
  constexpr std::uint64_t pixels = 640 * 480;
  EXPECT_EQ(bytes["camera_rays"], 9 * pixels * 48);
  EXPECT_EQ(bytes["resolve"], pixels * 16);
  EXPECT_EQ(render["rays"]["primary"], 9 * pixels);
}

}  // namespace
}  // namespace coppice
