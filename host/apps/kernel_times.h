#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/copy_limit.h"
#include "pipeline/traffic.h"
#include "stages/gpu_executor.h"

namespace coppice {

using Json = nlohmann::ordered_json;

// The steps of a chain that the device runs, and their times from one run with Timestamps::every_step.
struct KernelSplit {
  std::vector<Step> steps;  // without marks, and without indirect dispatches that were empty
  Recorder::Times times;
};

// Splits the time of `steps`, which the device has run before: timestamps around the dispatches that it then
// found empty would measure the timestamps.
KernelSplit split_time(GpuExecutor& executor, std::span<const Step> steps, double limit_seconds);

const char* step_name(const Step& step);

// One row of the table of kernels: all dispatches of a kernel.
struct KernelTime {
  std::string name;
  double ms = 0;
  std::uint32_t dispatches = 0;
  std::optional<std::uint64_t> bytes = 0;  // by the stages' models; empty for a stage without one
  std::optional<double> copy_ms = 0;       // what copies of the same sizes take; empty where not measured

  double gb_per_s() const { return static_cast<double>(bytes.value_or(0)) / (ms * 1e6); }
  double percent_of_copy() const { return 100 * copy_ms.value_or(0) / ms; }
};

struct KernelTable {
  std::vector<KernelTime> rows;  // in order of appearance
  double untimed_ms = 0;         // the same steps without a timestamp after each
  double copy_gb_per_s = 0;      // of the largest copy that was measured; 0: none

  KernelTime sum() const;
};

// The most bytes that a step of the split moves, by its model.
std::uint64_t largest_dispatch(const KernelSplit& split, const RunCounts& counts);

// Empty, with a note on stderr, where the device cannot measure it.
std::optional<CopyLimit> find_copy_limit(Device& device, std::uint64_t most_bytes);

KernelTable kernel_table(const KernelSplit& split, const RunCounts& counts,
                         const std::optional<CopyLimit>& limit, double untimed_ms);

// Rows; the sums are not among them.
Json to_json(const KernelTable& table);
void print_kernels(const KernelTable& table);

}  // namespace coppice
