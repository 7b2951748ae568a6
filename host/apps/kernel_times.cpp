#include "apps/kernel_times.h"

#include <algorithm>
#include <cstdio>

namespace coppice {

namespace {

std::vector<Step> measurable_steps(const GpuExecutor& executor, std::span<const Step> steps) {
  std::vector<Step> kept;
  for (const Step& step : steps) {
    if (!step.stage && step.clear_bytes == 0) continue;
    if (step.indirect && executor.read(Slot<uint>{step.place, 1})[0] == 0) continue;
    kept.push_back(step);
  }
  return kept;
}

// Nothing is known of a sum of which a part is unknown.
template <class T>
void add(std::optional<T>& sum, const std::optional<T>& part) {
  sum = sum && part ? std::optional<T>(*sum + *part) : std::nullopt;
}

void print_row(const KernelTime& kernel, double share) {
  std::printf("  %-18s %10.3f %6.1f%% %11u", kernel.name.c_str(), kernel.ms, share, kernel.dispatches);
  if (kernel.bytes) {
    std::printf(" %11.3f %8.2f", static_cast<double>(*kernel.bytes) * 1e-6, kernel.gb_per_s());
  } else {
    std::printf(" %11s %8s", "-", "-");
  }
  if (kernel.copy_ms) {
    std::printf(" %8.1f%%\n", kernel.percent_of_copy());
  } else {
    std::printf(" %9s\n", "-");
  }
}

}  // namespace

const char* step_name(const Step& step) { return step.stage ? step.stage->name : "clear"; }

KernelSplit split_time(GpuExecutor& executor, std::span<const Step> steps, double limit_seconds) {
  KernelSplit split{measurable_steps(executor, steps), {}};
  split.times = executor.record(split.steps, Timestamps::every_step).submit_and_wait(limit_seconds);
  return split;
}

KernelTime KernelTable::sum() const {
  KernelTime sum{.name = "sum"};
  for (const KernelTime& row : rows) {
    sum.ms += row.ms;
    sum.dispatches += row.dispatches;
    add(sum.bytes, row.bytes);
    add(sum.copy_ms, row.copy_ms);
  }
  return sum;
}

std::uint64_t largest_dispatch(const KernelSplit& split, const RunCounts& counts) {
  std::uint64_t largest = 0;
  for (const Step& step : split.steps) largest = std::max(largest, modelled_bytes(step, counts).value_or(0));
  return largest;
}

std::optional<CopyLimit> find_copy_limit(Device& device, std::uint64_t most_bytes) {
  try {
    return measure_copy_limit(device, most_bytes);
  } catch (const DeviceError& error) {
    std::fprintf(stderr, "note: no copy to compare the kernels with: %s\n", error.what());
    return std::nullopt;
  }
}

KernelTable kernel_table(const KernelSplit& split, const RunCounts& counts,
                         const std::optional<CopyLimit>& limit, double untimed_ms) {
  KernelTable table;
  table.untimed_ms = untimed_ms;
  for (std::size_t i = 0; i < split.times.steps_ms.size(); ++i) {
    const std::string name = step_name(split.steps[i]);
    auto row = std::ranges::find(table.rows, name, &KernelTime::name);
    if (row == table.rows.end()) row = table.rows.insert(row, {.name = name});
    const std::optional<std::uint64_t> bytes = modelled_bytes(split.steps[i], counts);
    row->ms += split.times.steps_ms[i];
    ++row->dispatches;
    add(row->bytes, bytes);
    add(row->copy_ms, limit && bytes ? std::optional(limit->ms(*bytes)) : std::nullopt);
  }
  if (limit) {
    const CopyLimit::Measurement& largest = limit->measurements().back();
    table.copy_gb_per_s = static_cast<double>(largest.bytes) / (largest.ms * 1e6);
  }
  return table;
}

Json to_json(const KernelTable& table) {
  const auto known = [](bool is_known, auto value) { return is_known ? Json(value) : Json(nullptr); };
  Json rows = Json::array();
  for (const KernelTime& kernel : table.rows) {
    rows.push_back({{"name", kernel.name},
                    {"ms", kernel.ms},
                    {"dispatches", kernel.dispatches},
                    {"bytes", known(kernel.bytes.has_value(), kernel.bytes.value_or(0))},
                    {"gb_per_s", known(kernel.bytes && kernel.ms > 0, kernel.gb_per_s())},
                    {"percent_of_copy", known(kernel.copy_ms && kernel.ms > 0, kernel.percent_of_copy())}});
  }
  return rows;
}

void print_kernels(const KernelTable& table) {
  const KernelTime sum = table.sum();
  std::printf("  %-18s %10s %7s %11s %11s %8s %9s\n", "kernel", "ms", "share", "dispatches", "MB", "GB/s",
              "of copy");
  for (const KernelTime& kernel : table.rows) print_row(kernel, 100 * kernel.ms / sum.ms);
  print_row(sum, 100);
  std::printf("  %.3f ms with a timestamp after each dispatch, %.3f ms without: %+.3f ms\n", sum.ms,
              table.untimed_ms, sum.ms - table.untimed_ms);
  if (table.copy_gb_per_s > 0)
    std::printf("  of copy: the time that plain copies of the same sizes take; large ones %.2f GB/s\n",
                table.copy_gb_per_s);
}

}  // namespace coppice
