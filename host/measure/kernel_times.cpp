#include "measure/kernel_times.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "measure/table.h"

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

// The columns of the table; share and MB are only shown, bytes only kept.
Table columns_of_kernels() {
  return Table({{.key = "name", .heading = "kernel", .width = -18, .gap = 2},
                {.key = "ms", .heading = "ms", .width = 10, .precision = 3},
                {.heading = "share", .width = 7, .precision = 1, .places = IN_TEXT, .unit = "%"},
                {.key = "dispatches", .heading = "dispatches", .width = 11},
                {.key = "bytes", .places = IN_JSON},
                {.heading = "MB", .width = 11, .precision = 3, .places = IN_TEXT},
                {.key = "gb_per_s", .heading = "GB/s", .width = 8, .precision = 2},
                {.key = "percent_of_copy", .heading = "of copy", .width = 9, .precision = 1, .unit = "%"}});
}

// `share`: of the sum, in percent.
Row kernel_row(const KernelTime& kernel, double share) {
  const bool took_time = kernel.ms > 0;
  const double megabytes = static_cast<double>(kernel.bytes) * 1e-6;
  std::optional<double> gb_per_s, percent_of_copy;
  if (took_time) gb_per_s = kernel.gb_per_s();
  if (kernel.copy_ms && took_time) percent_of_copy = kernel.percent_of_copy();
  return {
      {kernel.name, kernel.ms, share, kernel.dispatches, kernel.bytes, megabytes, gb_per_s, percent_of_copy}};
}

Table kernel_rows(const KernelTable& kernels, const KernelTime& sum) {
  Table table = columns_of_kernels();
  for (const KernelTime& kernel : kernels.rows) table.add(kernel_row(kernel, 100 * kernel.ms / sum.ms));
  return table;
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
    sum.bytes += row.bytes;
    add(sum.copy_ms, row.copy_ms);
  }
  return sum;
}

std::optional<CopyLimit> find_copy_limit(CheckedDevice& device, std::uint64_t most_bytes) {
  if (device.properties().timestamp_period_ns == 0) {
    note_timestamps(device);
    return std::nullopt;
  }
  try {
    return measure_copy_limit(device.device(), most_bytes);
  } catch (const DeviceError& error) {
    device.note(std::string("no copy to compare the kernels with: ") + error.what());
    return std::nullopt;
  }
}

void note_timestamps(CheckedDevice& device) {
  if (device.properties().timestamp_period_ns > 0) return;
  device.note_once(device.properties().name +
                   " has no timestamps: times are those of the host's clock, none of kernels");
}

void KernelSums::add(std::span<const Step> steps, const Recorder::Times& times, const RunCounts& counts) {
  untimed_ = untimed_ || (times.steps_ms.empty() && !steps.empty());
  for (std::size_t i = 0; i < times.steps_ms.size(); ++i) {
    const std::string name = step_name(steps[i]);
    const std::uint64_t bytes = modelled_bytes(steps[i], counts);
    const auto [entry, is_new] = index_.try_emplace({name, bytes}, sums_.size());
    if (is_new) sums_.push_back({name, bytes});
    Sum& sum = sums_[entry->second];
    sum.ms += times.steps_ms[i];
    ++sum.dispatches;
  }
}

std::uint64_t KernelSums::largest_dispatch() const {
  std::uint64_t largest = 0;
  for (const Sum& sum : sums_) largest = std::max(largest, sum.bytes);
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
    row->bytes += sum.bytes * sum.dispatches;
    add(row->copy_ms, limit ? std::optional(limit->ms(sum.bytes) * sum.dispatches) : std::nullopt);
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
  return table.untimed ? Json(nullptr) : kernel_rows(table, table.sum()).json();
}

std::string text_of(const KernelTable& table) {
  const KernelTime sum = table.sum();
  Table rows = kernel_rows(table, sum);
  rows.add(kernel_row(sum, 100));
  std::string text =
      rows.text() + format("  %.3f ms with a timestamp after each dispatch, %.3f ms without: %+.3f ms\n",
                           sum.ms, table.untimed_ms, sum.ms - table.untimed_ms);
  if (table.copy_gb_per_s > 0)
    text += format("  of copy: the time that plain copies of the same sizes take; large ones %.2f GB/s\n",
                   table.copy_gb_per_s);
  return text;
}

}  // namespace coppice
