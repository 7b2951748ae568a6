#include "apps/kernel_times.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace coppice {

namespace {

std::vector<Step> measurable_steps(const GpuExecutor& executor, std::span<const Step> steps) {
  std::vector<Step> kept;
  for (const Step& step : steps) {
    if (std::holds_alternative<Mark>(step)) continue;
    const Dispatch* const dispatch = dispatch_of(step);
    if (dispatch && dispatch->indirect && executor.read(Slot<uint>{*dispatch->indirect, 1})[0] == 0) continue;
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

const char* step_name(const Step& step) { return stage_of(step) ? stage_of(step)->name : "clear"; }

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

std::optional<CopyLimit> find_copy_limit(Device& device, std::uint64_t most_bytes) {
  if (device.properties().timestamp_period_ns == 0) {
    note_timestamps(device);
    return std::nullopt;
  }
  try {
    return measure_copy_limit(device, most_bytes);
  } catch (const DeviceError& error) {
    std::fprintf(stderr, "note: no copy to compare the kernels with: %s\n", error.what());
    return std::nullopt;
  }
}

void note_timestamps(const Device& device) {
  static bool said = false;
  if (device.properties().timestamp_period_ns > 0 || std::exchange(said, true)) return;
  std::fprintf(stderr, "note: %s has no timestamps: times are those of the host's clock, none of kernels\n",
               device.properties().name.c_str());
}

void KernelSums::add(std::span<const Step> steps, const Recorder::Times& times, const RunCounts& counts) {
  untimed_ = untimed_ || (times.steps_ms.empty() && !steps.empty());
  for (std::size_t i = 0; i < times.steps_ms.size(); ++i) {
    const std::string name = step_name(steps[i]);
    const std::optional<std::uint64_t> bytes = modelled_bytes(steps[i], counts);
    const auto [entry, is_new] = index_.try_emplace({name, bytes}, sums_.size());
    if (is_new) sums_.push_back({name, bytes});
    Sum& sum = sums_[entry->second];
    sum.ms += times.steps_ms[i];
    ++sum.dispatches;
  }
}

std::uint64_t KernelSums::largest_dispatch() const {
  std::uint64_t largest = 0;
  for (const Sum& sum : sums_) largest = std::max(largest, sum.bytes.value_or(0));
  return largest;
}

KernelTable kernel_table(const KernelSums& sums, const std::optional<CopyLimit>& limit, double untimed_ms) {
  KernelTable table;
  table.untimed = sums.untimed();
  table.untimed_ms = untimed_ms;
  for (const KernelSums::Sum& sum : sums.sums()) {
    auto row = std::ranges::find(table.rows, sum.name, &KernelTime::name);
    if (row == table.rows.end()) row = table.rows.insert(row, {.name = sum.name});
    row->ms += sum.ms;
    row->dispatches += sum.dispatches;
    add(row->bytes, sum.bytes ? std::optional(*sum.bytes * sum.dispatches) : std::nullopt);
    add(row->copy_ms,
        limit && sum.bytes ? std::optional(limit->ms(*sum.bytes) * sum.dispatches) : std::nullopt);
  }
  if (limit) {
    const CopyLimit::Measurement& largest = limit->measurements().back();
    table.copy_gb_per_s = static_cast<double>(largest.bytes) / (largest.ms * 1e6);
  }
  return table;
}

void sums_to_json(const KernelTable& table, Json& json) {
  json["timed_ms"] = table.untimed ? Json(nullptr) : Json(table.sum().ms);
  json["copy_gb_per_s"] = table.untimed ? Json(nullptr) : Json(table.copy_gb_per_s);
}

Json to_json(const KernelTable& table) {
  if (table.untimed) return nullptr;
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
