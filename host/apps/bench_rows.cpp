#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "apps/bench.h"

namespace coppice {

namespace {

std::string csv_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

// A field between quotes.
std::string quoted(std::string text) {
  for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
  return '"' + text + '"';
}

// The columns that not every row has.
std::vector<std::pair<std::string, double>> own_columns(const BenchRow& row) {
  auto columns = row.figures;
  for (const KernelTime& kernel : row.kernels.rows) {
    columns.emplace_back(kernel.name + "_ms", kernel.ms);
    if (kernel.bytes) columns.emplace_back(kernel.name + "_bytes", *kernel.bytes);
    if (kernel.copy_ms) columns.emplace_back(kernel.name + "_percent_of_copy", kernel.percent_of_copy());
  }
  return columns;
}

}  // namespace

BenchRow bench_row(std::string name, std::string input, std::uint64_t size, const SteadyTime& time) {
  return {.name = std::move(name),
          .input = std::move(input),
          .size = size,
          .ms = spread_of(time.runs_ms),
          .runs = static_cast<std::uint32_t>(time.runs_ms.size()),
          .warm_up_runs = time.warm_up_runs,
          .stable = time.stable,
          .figures = {},
          .note = {},
          .kernels = {}};
}

std::string bench_csv(const std::vector<BenchRow>& rows, const DeviceProperties& device) {
  std::vector<std::string> names;
  for (const BenchRow& row : rows) {
    for (const auto& [name, value] : own_columns(row)) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  std::string csv = "name,input,size,ms,ms_min,ms_max,millions_per_s,runs,warm_up_runs,stable";
  for (const std::string& name : names) csv += "," + name;
  csv += ",device,driver,date";
  const std::string origin = "," + quoted(device.name) + "," + quoted(device.driver) + "," + today();
  for (const BenchRow& row : rows) {
    csv += "\n" + quoted(row.name) + "," + quoted(row.input) + "," + std::to_string(row.size);
    for (const double value : {row.ms.median, row.ms.least, row.ms.greatest, row.millions_per_s()})
      csv += "," + csv_number(value);
    for (const std::uint32_t count : {row.runs, row.warm_up_runs, std::uint32_t{row.stable}})
      csv += "," + std::to_string(count);
    const auto columns = own_columns(row);
    for (const std::string& name : names) {
      const auto column = std::ranges::find(columns, name, &std::pair<std::string, double>::first);
      csv += column == columns.end() ? "," : "," + csv_number(column->second);
    }
    csv += origin;
  }
  return csv;
}

Json to_json(const BenchRow& row) {
  Json json = {{"name", row.name},
               {"input", row.input},
               {"size", row.size},
               {"ms", row.ms.median},
               {"ms_min", row.ms.least},
               {"ms_max", row.ms.greatest},
               {"millions_per_s", row.millions_per_s()},
               {"runs", row.runs},
               {"warm_up_runs", row.warm_up_runs},
               {"stable", row.stable}};
  for (const auto& [name, value] : row.figures) json[name] = value;
  if (!row.kernels.rows.empty()) json["kernels"] = to_json(row.kernels);
  return json;
}

SteadyOptions steady_options(const Options& options, double once_ms) {
  constexpr double batch_ms = 1000;
  SteadyOptions steady{.runs = options.runs};
  if (steady.batch * once_ms > batch_ms)
    steady.batch = static_cast<std::uint32_t>(std::max(1.0, batch_ms / once_ms));
  return steady;
}

std::vector<std::uint32_t> bench_sizes(std::uint32_t first, std::uint32_t most) {
  std::vector<std::uint32_t> sizes;
  for (std::uint64_t size = first; size < most; size *= 4) sizes.push_back(static_cast<std::uint32_t>(size));
  sizes.push_back(most);
  return sizes;
}

bool is_wanted(const Options& options, const std::string& name, const std::string& input) {
  const std::string row = name + " " + input;
  return options.only.empty() || std::ranges::any_of(options.only, [&](const std::string& part) {
           return row.find(part) != std::string::npos;
         });
}

}  // namespace coppice
