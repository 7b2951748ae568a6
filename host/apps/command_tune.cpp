#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "apps/bench.h"
#include "pipeline/variant_table.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

// What a stage's variants are measured on. Throws DeviceError if the result is wrong.
using Workload = BenchRow (*)(CheckedDevice&, const Options&, std::string_view variant);

struct TunedStage {
  std::string_view stage;
  Workload workload;
};

BenchRow sort_workload(CheckedDevice& device, const Options& options, std::string_view) {
  return bench_keys(device, options, options.most / 4 * 4, 1, true, "random");
}

// Its variants are named as trees are.
BenchRow trace_workload(CheckedDevice& device, const Options& options, std::string_view variant) {
  Options quarter = options;  // of a picture: enough rays for any device
  quarter.width /= 2;
  quarter.height /= 2;
  return bench_primary_rays(device, quarter, std::string(variant));
}

// A line for each of variant_stages().
constexpr TunedStage tuned_stages[] = {{"sort", sort_workload}, {"trace", trace_workload}};

constexpr std::uint32_t turns = 3;
constexpr double least_gain = 0.05;  // by less a variant does not displace the one of the rule: that is noise

// Every variant of the stage, several times in turn, as other work on the machine comes and goes: the row
// with the least median of each.
std::vector<BenchRow> measure_variants(CheckedDevice& device, const VariantStage& stage, Workload workload,
                                       const Options& options) {
  std::vector<BenchRow> best(stage.values.size());
  for (std::uint32_t turn = 0; turn < turns; ++turn) {
    for (std::uint32_t value = 0; value < stage.values.size(); ++value) {
      device.variants.*stage.value = value;
      BenchRow row = workload(device, options, stage.values[value]);
      if (turn == 0 || row.ms.median < best[value].ms.median) best[value] = std::move(row);
    }
  }
  return best;
}

// Keeps the fastest in device.variants.
Json tune_stage(CheckedDevice& device, const VariantStage& stage, Workload workload, const Options& options) {
  const std::uint32_t rule = stage.rule(device.device.properties());
  const std::vector<BenchRow> measured = measure_variants(device, stage, workload, options);
  const auto median = [](const BenchRow& row) { return row.ms.median; };
  auto best = static_cast<std::uint32_t>(std::ranges::min_element(measured, {}, median) - measured.begin());
  if (median(measured[best]) > median(measured[rule]) * (1 - least_gain)) best = rule;
  device.variants.*stage.value = best;
  Json rows = Json::array();
  for (std::uint32_t value = 0; value < measured.size(); ++value) {
    const BenchRow& row = measured[value];
    rows.push_back({{"variant", stage.values[value]}, {"ms", row.ms.median}, {"stable", row.stable}});
    if (!talks(options)) continue;
    std::printf("  %-10s %-15s %10.3f %10.3f %10.3f%s%s%s\n", stage.name.data(), stage.values[value].data(),
                row.ms.median, row.ms.least, row.ms.greatest, row.stable ? "" : "  not stable",
                value == best ? "  <- kept" : "", value == rule ? "  (default)" : "");
  }
  return {{"stage", stage.name},
          {"chosen", stage.values[best]},
          {"rule", stage.values[rule]},
          {"variants", rows}};
}

}  // namespace

int run_tune(const Options& options) {
  CheckedDevice device = open_device(options, {});
  const DeviceProperties& properties = device.device.properties();
  if (!device.lookback)
    throw DeviceError("without lookback there is one variant of each stage, and nothing to tune");
  if (talks(options)) {
    std::printf("%s, %s\n  %-10s %-15s %10s %10s %10s\n", properties.name.c_str(), properties.driver.c_str(),
                "stage", "variant", "median ms", "min", "max");
  }
  Json stages = Json::array();
  for (const VariantStage& stage : variant_stages()) {
    for (const TunedStage& tuned : tuned_stages) {
      if (tuned.stage == stage.name) stages.push_back(tune_stage(device, stage, tuned.workload, options));
    }
  }
  const std::filesystem::path file = device.device.kept_file("variants");
  if (file.empty())
    throw DeviceError("no folder to keep the table in: neither XDG_CACHE_HOME nor HOME is set");
  std::filesystem::create_directories(file.parent_path());
  write_file(file, variant_table_text(device.variants, properties));
  if (talks(options)) std::printf("written to %s\n", file.c_str());
  write_json(options.json, {{"device", properties.name},
                            {"driver", properties.driver},
                            {"stages", stages},
                            {"file", file.string()}});
  return validation_status(device.device);
}

}  // namespace coppice
