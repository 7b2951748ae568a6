#include "measure/tune.h"

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "measure/tuned_choice.h"
#include "scene/input_error.h"
#include "scene/printable.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

// What a stage's variants are measured on.
using Workload = BenchRow (*)(CheckedDevice&, const BenchOptions&, std::uint32_t variant);

BenchRow sort_workload(CheckedDevice& device, const BenchOptions& options, std::uint32_t) {
  return bench_keys(device, options, options.most / 4 * 4, 1, true, "random");
}

// Its variants are walks.
BenchRow trace_workload(CheckedDevice& device, const BenchOptions& options, std::uint32_t variant) {
  BenchOptions quarter = options;  // of a picture: enough rays for any device
  quarter.trace.width = (quarter.trace.width + 1) / 2;
  quarter.trace.height = (quarter.trace.height + 1) / 2;
  return bench_primary_rays(device, quarter, SceneOptions{}, Walk{variant});
}

struct StageWorkload {
  std::string_view stage;
  Workload workload;
};

// A line for each of variant_stages().
constexpr StageWorkload workloads[] = {{"sort", sort_workload}, {"trace", trace_workload}};

constexpr std::uint32_t turns = 5;

void set_variant(CheckedDevice& device, const VariantStage& stage, std::uint32_t value) {
  Variants variants = device.variants();
  variants.*stage.value = value;
  device.set_variants(variants);
}

// The rows of each variant that can run, one a turn: in turn, as other work on the machine comes and goes.
std::vector<std::vector<BenchRow>> measure_variants(CheckedDevice& device, const VariantStage& stage,
                                                    const BenchOptions& options) {
  const Workload workload = std::ranges::find(workloads, stage.name, &StageWorkload::stage)->workload;
  std::vector<std::vector<BenchRow>> rows(stage.values.size());
  for (std::uint32_t turn = 0; turn < turns; ++turn) {
    for (std::uint32_t value = 0; value < stage.values.size(); ++value) {
      if (!device.lookback() && stage.without_lookback(value) != value) continue;
      set_variant(device, stage, value);
      rows[value].push_back(workload(device, options, value));
    }
  }
  return rows;
}

const char* verdict(const TunedChoice& choice, std::uint32_t value, std::uint32_t rule) {
  if (value == choice.chosen) return value == rule ? "  <- kept (default)" : "  <- kept";
  if (value == choice.fastest) return "  fastest, but by no more than its spread or 5 %: that is noise";
  return value == rule ? "  (default)" : "";
}

}  // namespace

Table tuning_table() {
  return Table({{.heading = "stage", .width = -10, .places = IN_TEXT, .gap = 2},
                {.key = "variant", .heading = "variant", .width = -15},
                {.key = "ms", .heading = "median ms", .width = 10, .precision = 3},
                {.key = "ms_min", .heading = "min", .width = 10, .precision = 3},
                {.key = "ms_max", .heading = "max", .width = 10, .precision = 3},
                {.key = "stable", .places = IN_JSON}});
}

TunedStage tune_stage(CheckedDevice& device, const VariantStage& stage, const BenchOptions& options) {
  const std::uint32_t preset = stage.rule(device.properties());
  const std::uint32_t rule = device.lookback() ? preset : stage.without_lookback(preset);
  const auto measured = measure_variants(device, stage, options);
  std::vector<std::vector<double>> medians(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    for (const BenchRow& row : measured[i]) medians[i].push_back(row.ms.median);
  }
  const TunedChoice choice = choose_variant(medians, rule);
  // Where lookback returns one day, the rule's own variant is the one to have.
  const std::uint32_t kept = choice.chosen == rule ? preset : choice.chosen;
  set_variant(device, stage, kept);
  TunedStage tuned{&stage, kept, choice.fastest, choice.sure, preset, tuning_table()};
  for (std::uint32_t value = 0; value < measured.size(); ++value) {
    if (measured[value].empty()) continue;
    const Spread ms = spread_of(medians[value]);
    const bool stable = std::ranges::all_of(measured[value], &BenchRow::stable);
    const std::string remark = stable ? "" : "  not stable";
    tuned.variants.add({{stage.name, stage.values[value], ms.median, ms.least, ms.greatest, stable},
                        remark + verdict(choice, value, rule)});
  }
  return tuned;
}

Json to_json(const TunedStage& tuned) {
  const VariantStage& stage = *tuned.stage;
  return {
      {"stage", stage.name}, {"chosen", stage.values[tuned.chosen]}, {"fastest", stage.values[tuned.fastest]},
      {"sure", tuned.sure},  {"rule", stage.values[tuned.rule]},     {"variants", tuned.variants.json()}};
}

std::filesystem::path checked_table_file(const Device& device) {
  const std::filesystem::path file = device.kept_file("variants");
  if (file.empty())
    throw InputError("no folder to keep the table in: neither XDG_CACHE_HOME nor HOME is set");
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw InputError(printable(file.parent_path()) + ": cannot make the folder: " + error.message());
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError(printable(file) + ": is no regular file, so no table can be kept there");
  if (std::filesystem::exists(status) && access(file.c_str(), R_OK) != 0)
    throw InputError(printable(file) + ": cannot be read, so a table there would not be found");
  check_writable(file);
  return file;
}

}  // namespace coppice
