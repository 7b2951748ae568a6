#include <cstdio>

#include "apps/bench.h"

namespace coppice {

namespace {

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
  if (row.scratch_bytes > 0) json["scratch_bytes_per_triangle"] = row.scratch_bytes;
  return json;
}

void print_row(const BenchRow& row) {
  std::printf("  %-15s %-11s %10llu %10.3f %10.3f %10.3f %10.2f", row.name.c_str(), row.input.c_str(),
              static_cast<unsigned long long>(row.size), row.ms.median, row.ms.least, row.ms.greatest,
              row.millions_per_s());
  if (row.scratch_bytes > 0) std::printf("  %.1f bytes of scratch a triangle", row.scratch_bytes);
  std::printf("%s\n", row.stable ? "" : "  not stable");
  std::fflush(stdout);
}

// A field between quotes, as RFC 4180 has it.
std::string quoted(std::string text) {
  for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
  return '"' + text + '"';
}

std::string csv_line(const BenchRow& row, const DeviceProperties& device) {
  char numbers[200];
  std::snprintf(numbers, sizeof numbers, ",%llu,%.6f,%.6f,%.6f,%.4f,%u,%u,%d,%.2f,",
                static_cast<unsigned long long>(row.size), row.ms.median, row.ms.least, row.ms.greatest,
                row.millions_per_s(), row.runs, row.warm_up_runs, row.stable, row.scratch_bytes);
  return "\n" + quoted(row.name) + "," + quoted(row.input) + numbers + quoted(device.name) + "," +
         quoted(device.driver);
}

}  // namespace

int run_bench(const Options& options) {
  CheckedDevice device = open_device(options);
  const DeviceProperties& properties = device.device.properties();
  std::string csv =
      "name,input,size,ms,ms_min,ms_max,millions_per_s,runs,warm_up_runs,stable,"
      "scratch_bytes_per_triangle,device,driver";
  Json rows = Json::array();
  if (talks(options)) {
    std::printf("%s, %s\n  %-15s %-11s %10s %10s %10s %10s %10s\n", properties.name.c_str(),
                properties.driver.c_str(), "", "input", "size", "median ms", "min", "max", "millions/s");
  }
  const AddRow add = [&](const BenchRow& row) {
    if (talks(options)) print_row(row);
    rows.push_back(to_json(row));
    csv += csv_line(row, properties);
  };
  if (options.bench == "sort") bench_sort(device, options, add);
  if (options.bench == "build") bench_build(device, options, add);
  if (options.bench == "trace") bench_trace(device, options, add);
  if (!options.csv.empty()) write_text(options.csv, csv);
  write_json(options.json, {{"device", properties.name}, {"driver", properties.driver}, {"rows", rows}});
  return validation_status(device.device);
}

}  // namespace coppice
