#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/bench.h"
#include "scene/input_error.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

void print_row(const BenchRow& row) {
  std::printf("  %-15s %-16s %10llu %10.3f %10.3f %10.3f %10.2f", row.name.c_str(), row.input.c_str(),
              static_cast<unsigned long long>(row.size), row.ms.median, row.ms.least, row.ms.greatest,
              row.millions_per_s());
  if (!row.note.empty()) std::printf("  %s", row.note.c_str());
  std::printf("%s\n", row.stable ? "" : "  not stable");
  std::fflush(stdout);
}

}  // namespace

std::span<const NamedBench> benches() {
  static constexpr NamedBench list[] = {{"sort", bench_sort},
                                        {"scan", bench_scan},
                                        {"ploc", bench_ploc},
                                        {"build", bench_build},
                                        {"trace", bench_trace}};
  return list;
}

int run_bench(const Options& options) {
  CheckedDevice device = open_device(options, {});
  const DeviceProperties& properties = device.properties();
  note_timestamps(device.device());
  std::vector<BenchRow> rows;
  if (talks(options)) {
    std::printf("%s, %s\n  %-15s %-16s %10s %10s %10s %10s %10s\n", properties.name.c_str(),
                properties.driver.c_str(), "", "input", "size", "median ms", "min", "max", "millions/s");
  }
  std::ranges::find(benches(), options.bench, &NamedBench::name)->run(device, options, [&](BenchRow row) {
    if (talks(options)) print_row(row);
    rows.push_back(std::move(row));
  });
  if (rows.empty()) throw InputError("bench " + options.bench + ": nothing has what --only asks for");
  Json json = Json::array();
  for (const BenchRow& row : rows) json.push_back(to_json(row));
  if (!options.csv.empty()) write_file(options.csv, bench_csv(rows, properties) + "\n");
  write_json(options.json, {{"device", properties.name}, {"driver", properties.driver}, {"rows", json}});
  return validation_status(device.device());
}

}  // namespace coppice
