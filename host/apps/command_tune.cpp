#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/bench.h"
#include "apps/tuned_choice.h"
#include "pipeline/variant_table.h"
#include "scene/input_error.h"
#include "scene/printable.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

// What a stage's variants are measured on. Throws DeviceError if the result is wrong.
using Workload = BenchRow (*)(CheckedDevice&, const Options&, std::uint32_t variant);

struct TunedStage {
  std::string_view stage;
  Workload workload;
};

BenchRow sort_workload(CheckedDevice& device, const Options& options, std::uint32_t) {
  return bench_keys(device, options, options.most / 4 * 4, 1, true, "random");
}

// Its variants are walks.
BenchRow trace_workload(CheckedDevice& device, const Options& options, std::uint32_t variant) {
  Options quarter = options;  // of a picture: enough rays for any device
  quarter.width = (quarter.width + 1) / 2;
  quarter.height = (quarter.height + 1) / 2;
  return bench_primary_rays(device, quarter, Walk{variant});
}

// A line for each of variant_stages().
constexpr TunedStage tuned_stages[] = {{"sort", sort_workload}, {"trace", trace_workload}};

constexpr std::uint32_t turns = 5;

void set_variant(CheckedDevice& device, const VariantStage& stage, std::uint32_t value) {
  Variants variants = device.variants();
  variants.*stage.value = value;
  device.set_variants(variants);
}

// The rows of each variant that can run, one a turn: in turn, as other work on the machine comes and goes.
std::vector<std::vector<BenchRow>> measure_variants(CheckedDevice& device, const VariantStage& stage,
                                                    Workload workload, const Options& options) {
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

// A variant's medians over the turns.
Spread spread_of_turns(const std::vector<BenchRow>& rows, std::vector<double>& medians) {
  for (const BenchRow& row : rows) medians.push_back(row.ms.median);
  return medians.empty() ? Spread{} : spread_of(medians);
}

const char* verdict(const TunedChoice& choice, std::uint32_t value, std::uint32_t rule) {
  if (value == choice.chosen) return value == rule ? "  <- kept (default)" : "  <- kept";
  if (value == choice.fastest) return "  fastest, but by no more than its spread or 5 %: that is noise";
  return value == rule ? "  (default)" : "";
}

// Keeps in device.variants what is faster for sure, or else the rule's.
Json tune_stage(CheckedDevice& device, const VariantStage& stage, Workload workload, const Options& options) {
  const std::uint32_t preset = stage.rule(device.properties());
  const std::uint32_t rule = device.lookback() ? preset : stage.without_lookback(preset);
  const auto measured = measure_variants(device, stage, workload, options);
  std::vector<std::vector<double>> medians(measured.size());
  std::vector<Spread> spreads;
  for (std::size_t i = 0; i < measured.size(); ++i)
    spreads.push_back(spread_of_turns(measured[i], medians[i]));
  const TunedChoice choice = choose_variant(medians, rule);
  // Where lookback returns one day, the rule's own variant is the one to have.
  const std::uint32_t kept = choice.chosen == rule ? preset : choice.chosen;
  set_variant(device, stage, kept);
  Json rows = Json::array();
  for (std::uint32_t value = 0; value < measured.size(); ++value) {
    if (measured[value].empty()) continue;
    const Spread& ms = spreads[value];
    const bool stable = std::ranges::all_of(measured[value], &BenchRow::stable);
    rows.push_back({{"variant", stage.values[value]},
                    {"ms", ms.median},
                    {"ms_min", ms.least},
                    {"ms_max", ms.greatest},
                    {"stable", stable}});
    if (!talks(options)) continue;
    std::printf("  %-10s %-15s %10.3f %10.3f %10.3f%s%s\n", stage.name.data(), stage.values[value].data(),
                ms.median, ms.least, ms.greatest, stable ? "" : "  not stable", verdict(choice, value, rule));
  }
  return {{"stage", stage.name}, {"chosen", stage.values[kept]}, {"fastest", stage.values[choice.fastest]},
          {"sure", choice.sure}, {"rule", stage.values[preset]}, {"variants", rows}};
}

// Where the table goes, found fit for it before minutes are spent.
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

}  // namespace

int run_tune(const Options& options) {
  CheckedDevice device = open_device(options, {});
  const DeviceProperties& properties = device.properties();
  const std::filesystem::path file = checked_table_file(device.device());
  if (talks(options)) {
    std::printf("%s, %s\n  %-10s %-15s %10s %10s %10s\n", properties.name.c_str(), properties.driver.c_str(),
                "stage", "variant", "median ms", "min", "max");
    if (!device.lookback()) std::printf("  without lookback, and so without the variants that need it\n");
  }
  Json stages = Json::array();
  for (const VariantStage& stage : variant_stages()) {
    for (const TunedStage& tuned : tuned_stages) {
      if (tuned.stage == stage.name) stages.push_back(tune_stage(device, stage, tuned.workload, options));
    }
  }
  write_file(file, variant_table_text(device.variants(), properties));
  if (talks(options)) std::printf("written to %s\n", file.c_str());
  write_json(options.json, {{"device", properties.name},
                            {"driver", properties.driver},
                            {"stages", stages},
                            {"file", file.string()}});
  return validation_status(device.device());
}

}  // namespace coppice
