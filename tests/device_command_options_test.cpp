// Every option does what it says where a command takes it, and is refused elsewhere; outputs come out as they
// are named, or nothing is done.
#include <nlohmann/json.hpp>

#include "support/command.h"

namespace coppice {
namespace {

TEST_F(Command, OptionsThatWouldDoNothingAreRefused) {
  const struct {
    const char *arguments, *option;
  } cases[] = {
      // Unknown to the command.
      {"lockstep one.obj --trace-events e.json", "--trace-events"},
      {"compare one.obj --trace-events e.json", "--trace-events"},
      {"stability --trace-events e.json", "--trace-events"},
      {"bench sort --trace-events e.json", "--trace-events"},
      {"tune --trace-events e.json", "--trace-events"},
      {"scenes --trace-events e.json", "--trace-events"},
      {"devices --trace-events e.json", "--trace-events"},
      {"compare one.obj --validate", "--validate"},
      {"scenes --validate", "--validate"},
      {"devices --validate", "--validate"},
      {"render one.obj --rounds", "--rounds"},
      {"lockstep one.obj --rounds", "--rounds"},
      {"compare one.obj --rounds", "--rounds"},
      {"stability --rounds", "--rounds"},
      {"bench build --rounds", "--rounds"},
      {"tune --rounds", "--rounds"},
      {"scenes --lookback off", "--lookback"},
      {"devices --lookback off", "--lookback"},
      // Without effect beside the other options.
      {"build one.obj --builder sah --trace-events e.json", "--trace-events"},
      {"build one.obj --builder none --validate", "--validate"},
      {"build one.obj --builder ploc --lookback off", "--lookback"},
      {"build one.obj --builder ploc --variants sort=scan", "--variants"},
      {"build one.obj --builder ploc --rounds", "--rounds"},
      {"build one.obj --builder gpu-hploc --rounds", "--rounds"},
      {"build one.obj --builder gpu-lbvh --rounds", "--rounds"},
      {"build one.obj --builder lbvh --wide", "--wide"},
      {"render one.obj --builder sah --tracer cpu --trace-events e.json", "--trace-events"},
      {"render one.obj --builder sah --tracer cpu --validate", "--validate"},
      {"render one.obj --builder sah --tracer cpu --variants default", "--variants"},
      {"render one.obj --builder sah --lookback on", "--lookback"},
      {"render one.obj --tracer cpu --kernels", "--kernels"},
      {"render one.obj --tracer cpu --tree wide", "--tree"},
      {"render one.obj --tracer cpu --triangle-test fast", "--triangle-test"},
      {"render one.obj --tracer cpu --box-test fast", "--box-test"},
      {"compare one.obj --builders sah,ploc --lookback off", "--lookback"},
      {"compare one.obj --builders sah,ploc --variants default", "--variants"},
      {"bench sort one.obj", "SCENE"},
      {"bench build one.obj", "SCENE"},
      {"bench sort --builder gpu-ploc", "--builder"},
      {"bench ploc --builder gpu-ploc", "--builder"},
      {"bench sort --radius 8", "--radius"},
      {"bench scan --morton-bits 30", "--morton-bits"},
      {"bench scan --variants default", "--variants"},
      {"bench build --size 8x8", "--size"},
      {"bench sort --camera 0,0,0,1,1,1", "--camera"},
      {"bench sort --up z", "--up"},
      {"bench trace --most 1000", "--most"},
  };
  for (const auto& c : cases) {
    expect_refused(c.arguments, 2, c.option);
    EXPECT_FALSE(fs::exists("e.json")) << c.arguments;
  }
}

TEST_F(Command, OptionsDoWhatTheySayWhereTheyAreTaken) {
  const char* const events[] = {"build one.obj --runs 1", "render terrain:500 --size 32x24 -o p.png",
                                "render terrain:500 --size 32x24 -o p.png --builder ploc",
                                "render terrain:500 --size 32x24 -o p.png --builder gpu-lbvh --tracer cpu"};
  for (const std::string arguments : events) {
    const Outcome outcome = run(arguments + " --validate --trace-events e.json");
    ASSERT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
    EXPECT_FALSE(nlohmann::json::parse(read("e.json"))["traceEvents"].empty()) << arguments;
    fs::remove("e.json");
  }
  for (const bool lookback : {true, false}) {
    const std::string flag = lookback ? " --lookback on" : " --lookback off";
    for (const std::string arguments :
         {"build terrain:500 --runs 1", "render terrain:500 --size 8x8 -o p.png"}) {
      const Outcome outcome = run(arguments + flag + " --json -");
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      const auto report = nlohmann::json::parse(outcome.out);
      EXPECT_EQ((report.contains("build") ? report["build"] : report)["lookback"], lookback) << arguments;
    }
    const Outcome outcome = run("compare terrain:500 --builders ploc,gpu-ploc --size 8x8 --json -" + flag);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out)[0]["builders"];
    EXPECT_FALSE(rows[0].contains("lookback"));
    EXPECT_EQ(rows[1]["lookback"], lookback);
  }
}

TEST_F(Command, OutputsThatWouldNotComeOutAsNamedAreRefused) {
  fs::create_symlink("later.png", "link.png");  // to what is not there yet
  fs::create_directory("folder");
  fs::create_directory_symlink("folder", "other");
  fs::create_hard_link("one.obj", "twin.obj");
  const struct {
    const char *arguments, *part;
  } cases[] = {
      {"render one.obj -o x.jpg", "x.jpg"},
      {"render one.obj -o x.png.JPEG", "x.png.JPEG"},
      {"render one.obj -o x.obj", "x.obj"},
      {"compare one.obj --plot x.png", "x.png"},
      {"render one.obj -o -", "'-'"},
      {"build one.obj --trace-events -", "--trace-events: '-'"},
      {"compare one.obj --markdown -", "--markdown: '-'"},
      {"compare one.obj --plot -", "--plot: '-'"},
      {"bench sort --csv -", "--csv: '-'"},
      {"render one.obj -o ''", "no file name"},
      {"build one.obj --json ''", "no file name"},
      {"render one.obj -o a.png --json a.png", "one file"},
      {"render one.obj -o a.png --json ./a.png", "one file"},
      {"render one.obj -o a.png --json $PWD/a.png", "one file"},
      {"render one.obj -o a.png --trace-events folder/../a.png", "one file"},
      {"render one.obj -o folder/a.png --json other/a.png", "one file"},
      {"render one.obj -o link.png --json later.png", "one file"},
      {"render one.obj --json coppice.png", "one file"},  // where -o goes by default
      {"build one.obj --trace-events a --json a", "one file"},
      {"compare one.obj --markdown a --json a", "one file"},
      {"compare one.obj --markdown a.svg --plot a.svg", "one file"},
      {"bench sort --csv a --json a", "one file"},
      {"build one.obj --json one.obj", "the scene"},
      {"build one.obj --trace-events twin.obj", "the scene"},
      {"compare terrain:500 one.obj --markdown one.obj", "the scene"},
  };
  const std::string scene = read("one.obj");
  for (const auto& c : cases) {
    expect_refused(c.arguments, 2, c.part);
    for (const char* file : {"-", "a", "a.png", "later.png", "folder/a.png", "coppice.png"})
      EXPECT_FALSE(fs::exists(file)) << c.arguments;
    EXPECT_EQ(read("one.obj"), scene) << c.arguments;
  }
  const Outcome both = run("build one.obj --runs 1 --json stdout.txt");
  EXPECT_EQ(both.status, 2) << both.err;  // where run() sends stdout
}

TEST_F(Command, OutputsThatComeOutAsNamedAreTaken) {
  for (const char* arguments : {"render one.obj --size 8x8 -o p.PNG", "render one.obj --size 8x8 -o picture",
                                "render one.obj --size 8x8 -o /dev/null --json /dev/null",
                                "render one.obj --size 8x8 -o p.png --json p.json --trace-events p.txt"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
  }
}

TEST_F(Command, KnowsItsVersionAndItsCommands) {
  const Outcome version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.out.starts_with("coppice ")) << version.out;
  EXPECT_EQ(std::ranges::count(version.out, '\n'), 1);
  for (const char* arguments : {"", "nonsense", "one.obj", "Render"}) {
    for (const char* name :
         {"render", "build", "lockstep", "compare", "stability", "bench", "tune", "scenes", "devices"})
      expect_refused(arguments, 2, name);
  }
}

TEST_F(Command, AFullDiskBehindStdoutFailsTheRun) {
  for (const std::string arguments :
       {"build one.obj --runs 1", "build one.obj --runs 1 --json -", "render one.obj --size 8x8 -o p.png",
        "lockstep one.obj --size 8x8", "scenes", "devices", "scenes --json -", "--version", "--help-all",
        "bench scan --most 64 --runs 1", "compare one.obj --builders ploc --size 8x8"}) {
    for (const char* to : {"/dev/full", "&-"}) {
      const int status = std::system(
          (std::string("timeout 120 ") + COPPICE_PROGRAM + " " + arguments + " 2>err.txt >" + to).c_str());
      EXPECT_EQ(WEXITSTATUS(status), 1) << arguments << " >" << to;
      EXPECT_NE(read("err.txt").find("stdout"), std::string::npos) << read("err.txt");
      EXPECT_EQ(std::ranges::count(without_notes(read("err.txt")), '\n'), 1) << read("err.txt");
    }
  }
}

TEST_F(Command, NoLoaderOrDriverIsOneLineThatNamesThePackage) {
  const struct {
    const char *environment, *part;
  } cases[] = {{"VK_DRIVER_FILES=/nonexistent", "VK_DRIVER_FILES=/nonexistent"},
               {"-u VK_DRIVER_FILES VK_ICD_FILENAMES=/nonexistent", "VK_ICD_FILENAMES=/nonexistent"},
               {"VK_LOADER_DRIVERS_SELECT=nothing*", "VK_LOADER_DRIVERS_SELECT=nothing*"},
               {"LD_LIBRARY_PATH=$PWD/no_loader", "libvulkan1"}};
  // A library of that name that is none: what comes first is tried, and there it ends.
  fs::create_directory("no_loader");
  for (const char* name : {"no_loader/libvulkan.so", "no_loader/libvulkan.so.1"}) write(name, "");
  for (const auto& c : cases) {
    for (const char* arguments : {"devices", "render one.obj -o out.png", "build one.obj", "lockstep one.obj",
                                  "bench scan --most 64", "tune", "devices --json d.json"}) {
      const std::string command = std::string("env ") + c.environment + " timeout 120 " + COPPICE_PROGRAM +
                                  " " + arguments + " >stdout.txt 2>err.txt";
      EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1) << command;
      const std::string err = read("err.txt");
      EXPECT_NE(err.find(c.part), std::string::npos) << err;
      EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
    }
  }
  EXPECT_EQ(nlohmann::json::parse(read("d.json")), nlohmann::json::array());
}

// Runs on an old lavapipe too, see test.sh.
TEST_F(Command, AnOldLavapipeIsSaidToBeSlowAndNoOther) {
  const Outcome outcome = run("build one.obj --runs 1 --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  const std::string driver = report["driver"];
  const bool lavapipe = report["device"].get<std::string>().starts_with("llvmpipe");
  const bool old = lavapipe && driver.starts_with("Mesa ") && std::atoi(driver.c_str() + 5) < 25;
  EXPECT_EQ(outcome.err.find("times slower") != std::string::npos, old) << driver << ": " << outcome.err;
  if (!old) return;
  EXPECT_NE(outcome.err.find("./run.sh"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  const Outcome compared = run("compare one.obj --builders ploc,sah --size 8x8");  // whose rows run on it
  EXPECT_EQ(std::ranges::count(compared.err, '\n'), 1) << compared.err;
  EXPECT_NE(compared.err.find("./run.sh"), std::string::npos) << compared.err;
}

}  // namespace
}  // namespace coppice
