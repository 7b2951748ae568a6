#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "measure/bench.h"

namespace coppice {

namespace {

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

constexpr unsigned in_files = IN_CSV | IN_JSON, everywhere = IN_TEXT | in_files;

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

Table bench_table() {
  return Table(
      {{.key = "name", .width = -15, .places = everywhere, .gap = 2},
       {.key = "input", .heading = "input", .width = -16, .places = everywhere},
       {.key = "size", .heading = "size", .width = 10, .places = everywhere},
       {.key = "ms", .heading = "median ms", .width = 10, .precision = 3, .places = everywhere},
       {.key = "ms_min", .heading = "min", .width = 10, .precision = 3, .places = everywhere},
       {.key = "ms_max", .heading = "max", .width = 10, .precision = 3, .places = everywhere},
       {.key = "millions_per_s", .heading = "millions/s", .width = 10, .precision = 2, .places = everywhere},
       {.key = "runs", .places = in_files},
       {.key = "warm_up_runs", .places = in_files},
       {.key = "stable", .places = in_files}});
}

const Row& add_row(Table& table, const BenchRow& row) {
  std::vector<Cell> cells = {row.name,
                             row.input,
                             row.size,
                             row.ms.median,
                             row.ms.least,
                             row.ms.greatest,
                             row.millions_per_s(),
                             row.runs,
                             row.warm_up_runs,
                             row.stable};
  const auto set = [&](Column column, Cell cell) {
    const std::size_t index = table.column(column);
    if (cells.size() <= index) cells.resize(index + 1);
    cells[index] = std::move(cell);
  };
  for (const auto& [name, value] : row.figures) set({.key = name, .places = in_files}, value);
  for (const KernelTime& kernel : row.kernels.rows) {
    set({.key = kernel.name + "_ms", .places = IN_CSV}, kernel.ms);
    set({.key = kernel.name + "_bytes", .places = IN_CSV}, kernel.bytes);
    if (kernel.copy_ms)
      set({.key = kernel.name + "_percent_of_copy", .places = IN_CSV}, kernel.percent_of_copy());
  }
  const std::string note = row.note.empty() ? "" : "  " + row.note;
  return table.add({std::move(cells), note + (row.stable ? "" : "  not stable")});
}

std::string csv_of(Table table, const DeviceProperties& device) {
  table.set_all({.key = "device", .places = IN_CSV}, device.name);
  table.set_all({.key = "driver", .places = IN_CSV}, device.driver);
  table.set_all({.key = "date", .places = IN_CSV, .quoted = false}, today());
  return table.csv();
}

Json to_json(const Table& table, std::span<const BenchRow> rows) {
  Json list = table.json();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].kernels.rows.empty()) list[i]["kernels"] = to_json(rows[i].kernels);
  }
  return list;
}

std::span<const NamedBench> benches() {
  static constexpr NamedBench list[] = {
      {"sort", bench_sort},   {"scan", bench_scan},   {"ploc", bench_ploc},          {"build", bench_build},
      {"refit", bench_refit}, {"trace", bench_trace}, {"instances", bench_instances}};
  return list;
}

SteadyOptions steady_options(const BenchOptions& options, double once_ms) {
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

bool is_wanted(const BenchOptions& options, const std::string& name, const std::string& input) {
  const std::string row = name + " " + input;
  return options.only.empty() || std::ranges::any_of(options.only, [&](const std::string& part) {
           return row.find(part) != std::string::npos;
         });
}

}  // namespace coppice
