// What the command line measures: kernels of a build and of a picture, benches, tuned variants.
#include <nlohmann/json.hpp>
#include <optional>

#include "interface/ploc.h"
#include "support/command.h"

namespace coppice {
namespace {

TEST_F(Command, BuildSaysWhatEveryKernelMoves) {
  const Outcome outcome = run("build scatter:20000 --runs 1 --rounds --validate --json report.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto report = nlohmann::json::parse(read("report.json"));
  double sum = 0;
  for (const auto& kernel : report["kernels"]) {
    sum += kernel["ms"].get<double>();
    EXPECT_NEAR(kernel["gb_per_s"], kernel["bytes"].get<double>() / (kernel["ms"].get<double>() * 1e6), 1e-9)
        << kernel["name"];
    EXPECT_GT(kernel["percent_of_copy"], 0) << kernel["name"];
    EXPECT_NE(outcome.out.find(kernel["name"].get<std::string>() + " "), std::string::npos);
  }
  EXPECT_NEAR(report["timed_ms"], sum, 1e-9);
  EXPECT_GT(report["copy_gb_per_s"], 0);
  EXPECT_EQ(report["kernels"][1]["name"], "primitive_bounds");
  EXPECT_EQ(report["kernels"][1]["bytes"], 20000 * 60);
  for (const char* part : {"GB/s", "of copy", "with a timestamp after each dispatch", "ploc_finish, all"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
}

TEST_F(Command, RoundsEndWithOneCluster) {
  for (const char* lookback : {"on", "off"}) {
    const Outcome outcome =
        run(std::string("build scatter:20000 --runs 1 --rounds --json - --lookback ") + lookback);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    const auto& rounds = report["ploc_rounds"];
    ASSERT_GT(rounds.size(), 2u);
    EXPECT_EQ(rounds[0]["clusters"], 20000);
    for (std::size_t i = 0; i + 1 < rounds.size(); ++i) {
      EXPECT_EQ(rounds[i]["round"], i);
      EXPECT_EQ(rounds[i]["clusters"].get<int>() - rounds[i]["merged"].get<int>(), rounds[i + 1]["clusters"]);
      EXPECT_GT(rounds[i]["ms"], 0);
      EXPECT_EQ(rounds[i]["finish"], false);
    }
    EXPECT_EQ(rounds.back()["finish"], true);
    EXPECT_LE(rounds.back()["clusters"], PLOC_FINISH_CLUSTERS);
    EXPECT_EQ(rounds.back()["clusters"].get<int>() - rounds.back()["merged"].get<int>(), 1);
  }
}

TEST_F(Command, RenderSplitsItsTimeOnlyWhenAsked) {
  const Outcome plain = run("render terrain:500 --size 64x48 -o out.png");
  EXPECT_EQ(plain.out.find("primitive_bounds"), std::string::npos) << plain.out;
  const Outcome asked = run("render terrain:500 --size 64x48 --tree binary -o out.png --kernels");
  ASSERT_EQ(asked.status, 0) << asked.err;
  for (const char* part : {"primitive_bounds", "trace_closest", "of copy"})
    EXPECT_NE(asked.out.find(part), std::string::npos) << part;
}

TEST_F(Command, BenchChecksAndTimes) {
  const struct {
    const char *arguments, *last_name;
    std::size_t rows;
    int last_size;
    const char* column;  // besides those that all rows have
  } cases[] = {
      {"sort --most 5000", "sort_keys_64", 4 * 4 * 3, 5000, nullptr},
      {"sort --most 5000 --only sort_keys_32,few-bits", "sort_keys_64", (4 + 3) * 3, 5000, nullptr},
      {"scan --most 40000", "scan", 4, 40000, "times_std"},
      {"ploc --most 12000", "ploc", 2, 12000, "ns_per_cluster"},
      {"build --most 12000", "gpu-lbvh", 3 * 2, 12000, "hploc_build_ms"},
      {"build --most 10000 --builder gpu-ploc,gpu-hploc", "gpu-hploc", 2, 10000,
       "ploc_merge_percent_of_copy"},
      {"refit --most 12000 --builder gpu-ploc", "refit-wide-ploc", 2 * 2, 12000, "times_copy"},
      {"refit terrain:500", "refit-wide-lbvh", 3 * 2, 500, "order_ms"},
      {"trace terrain:500 --size 32x24 --builder gpu-lbvh", "trace_shadow_any", 10, 0, "not_as_on_cpu"},
      {"instances --most 500 --size 32x24 --builder gpu-lbvh", "instances_trace", 3, 768,
       "instance_boxes_ms"}};
  for (const auto& c : cases) {
    const Outcome outcome =
        run(std::string("bench ") + c.arguments + " --runs 2 --validate --csv rows.csv --json -");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out)["rows"];
    ASSERT_EQ(rows.size(), c.rows) << c.arguments;
    EXPECT_EQ(rows.back()["name"], c.last_name);
    if (c.last_size) {
      EXPECT_EQ(rows.back()["size"], c.last_size);
    }
    for (const auto& row : rows) {
      EXPECT_EQ(row["runs"], 2);
      EXPECT_GE(row["warm_up_runs"], 2);
      EXPECT_LE(row["ms_min"], row["ms"]);
      EXPECT_LE(row["ms"], row["ms_max"]);
    }
    const std::string csv = read("rows.csv");
    EXPECT_EQ(std::ranges::count(csv, '\n'), static_cast<int>(c.rows) + 1);
    const std::string header = csv.substr(0, csv.find('\n'));
    EXPECT_TRUE(header.ends_with(",device,driver,date")) << header;
    if (c.column) {
      EXPECT_NE(header.find("," + std::string(c.column) + ","), std::string::npos) << header;
    }
  }
}

// Every line of a table has the columns of its header, whichever rows have a value there.
TEST_F(Command, BenchLeavesColumnsEmptyThatARowLacks) {
  ASSERT_EQ(run("bench build --most 10000 --runs 1 --builder gpu-ploc,gpu-lbvh --csv rows.csv").status, 0);
  std::istringstream lines(read("rows.csv"));
  std::vector<std::ptrdiff_t> commas;
  for (std::string line; std::getline(lines, line);) {
    for (bool quoted = false; char& c : line) {
      quoted ^= c == '"';
      if (quoted && c == ',') c = ' ';
    }
    commas.push_back(std::ranges::count(line, ','));
  }
  ASSERT_EQ(commas.size(), 3u);
  EXPECT_EQ(commas[1], commas[0]);
  EXPECT_EQ(commas[2], commas[0]);
}

TEST_F(Command, BenchRefusesWhatItCannotMeasure) {
  const struct {
    const char *arguments, *part;
  } cases[] = {{"bench", "WHAT"},
               {"bench nonsense", "nonsense"},
               {"bench scan --most 3", "--most"},
               {"bench scan --most 67108865", "--most"},
               {"bench sort --runs 0", "--runs"},
               {"bench build --builder nonsense", "nonsense"},
               {"bench build --builder gpu-ploc,sah", "sah"},
               {"bench build --nonsense", "nonsense"},
               {"bench trace --size 0x0", "--size"}};
  for (const auto& c : cases) expect_refused(c.arguments, 2, c.part);
  expect_refused("bench sort --csv nowhere/rows.csv", 1, "nowhere/rows.csv");
  expect_refused("bench scan --only sort", 1, "--only");
  expect_refused("bench trace nonsense", 1, "nonsense");
}

// The file that starts so in the folder; empty if there is none.
std::string kept_file(const fs::path& folder, const std::string& stem) {
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().filename().string().starts_with(stem)) return file.path();
  return {};
}

// Commands with a cache in the folder of the test.
class CommandWithCache : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    if (const char* const home = std::getenv("XDG_CACHE_HOME")) before_ = home;
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  void TearDown() override {
    before_ ? setenv("XDG_CACHE_HOME", before_->c_str(), 1) : unsetenv("XDG_CACHE_HOME");
    Command::TearDown();
  }

  std::string table() const { return kept_file(folder_ / "coppice", "variants-"); }

  // Where the table is kept, once a run has shown how this device's files are named.
  std::string table_to_be() const {
    EXPECT_EQ(run("build one.obj --runs 1").status, 0);
    std::string pipelines = kept_file(folder_ / "coppice", "pipelines-");
    return pipelines.empty() ? pipelines : pipelines.replace(pipelines.rfind("pipelines-"), 10, "variants-");
  }

 private:
  std::optional<std::string> before_;
};

TEST_F(CommandWithCache, WhateverBearsTheNameOfAKeptFileIsNotWaitedFor) {
  const std::string variants = table_to_be();
  ASSERT_FALSE(variants.empty());
  const std::string pipelines = kept_file(folder_ / "coppice", "pipelines-");
  write("large", "");
  fs::resize_file("large", std::uintmax_t{1} << 33);  // without any block
  const struct {
    const char *make, *said;
  } cases[] = {{"mkfifo", "is no regular file"},
               {"ln -s /dev/zero", "is no regular file"},
               {"ln -s $PWD/large", "is larger than"},
               {"mkdir", "is no regular file"}};
  for (const auto& c : cases) {
    for (const std::string& file : {variants, pipelines}) {
      fs::remove(file);
      ASSERT_EQ(std::system((std::string(c.make) + " '" + file + "'").c_str()), 0);
      const Outcome outcome = run("build one.obj --runs 1");
      EXPECT_EQ(outcome.status, 0) << c.make << ": " << outcome.err;
      EXPECT_EQ(outcome.err.find(c.said) != std::string::npos, file == variants) << outcome.err;
      if (file == variants && !fs::is_regular_file(file))
        expect_refused("tune --most 1000 --runs 1", 1, "is no regular file");
      fs::remove(file);
    }
  }
}

TEST_F(CommandWithCache, TuneLooksAtItsFileBeforeItMeasures) {
  write("coppice", "no folder");
  expect_refused("tune", 1, "coppice: cannot make the folder");
  unsetenv("XDG_CACHE_HOME");
  const std::optional<std::string> home =
      std::getenv("HOME") ? std::optional<std::string>(std::getenv("HOME")) : std::nullopt;
  unsetenv("HOME");
  expect_refused("tune", 1, "neither XDG_CACHE_HOME nor HOME");
  if (home) setenv("HOME", home->c_str(), 1);
}

TEST_F(CommandWithCache, TuneWithoutLookbackMeasuresWhatStillRuns) {
  const Outcome tune = run("tune --lookback off --most 3000 --size 64x48 --runs 1 --json -");
  ASSERT_EQ(tune.status, 0) << tune.err;
  const auto stages = nlohmann::json::parse(tune.out)["stages"];
  ASSERT_EQ(stages.size(), 2u);
  for (const auto& row : stages[0]["variants"])
    EXPECT_EQ(row["variant"].get<std::string>().find("onesweep"), std::string::npos);
  EXPECT_EQ(stages[0]["variants"].size(), 3u);
  EXPECT_EQ(stages[1]["variants"].size(), 3u);
  EXPECT_FALSE(table().empty());
}

TEST_F(CommandWithCache, TuneKeepsATableThatLaterRunsRead) {
  const auto variants_of_a_build = [](const std::string& arguments, std::string& err) {
    const Outcome build = run("build terrain:500 --runs 1 --json - " + arguments);
    err = build.err;
    EXPECT_EQ(build.status, 0) << build.err;
    return build.status ? "" : nlohmann::json::parse(build.out)["variants"].get<std::string>();
  };
  std::string err;
  const std::string by_rule = variants_of_a_build("", err);
  EXPECT_EQ(variants_of_a_build("--variants sort=onesweep-match,trace=wide-single", err),
            "sort=onesweep-match,trace=wide-single");

  const Outcome tune = run("tune --most 3000 --size 64x48 --runs 1 --validate --json -");
  ASSERT_EQ(tune.status, 0) << tune.err;
  const auto stages = nlohmann::json::parse(tune.out)["stages"];
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0]["variants"].size(), 5u);
  EXPECT_EQ(stages[1]["variants"].size(), 3u);
  const std::string table = this->table();
  ASSERT_FALSE(table.empty());
  for (const auto& stage : stages) {
    EXPECT_TRUE(stage["sure"] || stage["chosen"] == stage["rule"])
        << stage;  // what noise decided is not kept
  }
  const std::string text = read(table), sort = "sort=" + stages[0]["chosen"].get<std::string>(),
                    trace = "trace=" + stages[1]["chosen"].get<std::string>();
  EXPECT_TRUE(text.ends_with("\n" + sort + "\n" + trace + "\n")) << text;
  EXPECT_EQ(variants_of_a_build("", err), sort + "," + trace);

  write(table, text.substr(0, text.find("sort=")) + "sort=scan-11\ntrace=binary\n");
  EXPECT_EQ(variants_of_a_build("", err), "sort=scan-11,trace=binary");
  const Outcome picture = run("render terrain:500 --size 64x48 -o out.png --json -");
  ASSERT_EQ(picture.status, 0) << picture.err;
  EXPECT_EQ(nlohmann::json::parse(picture.out)["tree"], "binary");
  EXPECT_EQ(variants_of_a_build("--variants default", err), by_rule);
  EXPECT_EQ(err.find("variants-"), std::string::npos) << err;

  write(table, "corrupt");
  EXPECT_EQ(variants_of_a_build("", err), by_rule);
  EXPECT_NE(err.find("is no table of variants; ignored"), std::string::npos) << err;
  EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
}

}  // namespace
}  // namespace coppice
