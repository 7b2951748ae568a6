#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "measure/copy_limit.h"
#include "measure/json.h"
#include "measure/traffic.h"
#include "pipeline/checked_device.h"
#include "stages/gpu_executor.h"

namespace coppice {

// The steps of a chain that the device runs, and their times from one run with Timestamps::every_step; no
// times from a device without timestamps.
struct KernelSplit {
  std::vector<Step> steps;  // without marks, and without indirect dispatches that were empty
  Recorder::Times times;
};

// Splits the time of `steps`, which the device has run before: timestamps around the dispatches that it then
// found empty would measure the timestamps.
KernelSplit split_time(GpuExecutor& executor, std::span<const Step> steps, double limit_seconds);

const char* step_name(const Step& step);

// Notes once that a device has no timestamps, so that there are no times of kernels.
void note_timestamps(CheckedDevice& device);

// Times of kernels summed up, so that a trace of any length takes little memory: one sum for all dispatches
// of a kernel that move as many bytes.
class KernelSums {
 public:
  KernelSums() = default;
  KernelSums(const KernelSplit& split, const RunCounts& counts) { add(split.steps, split.times, counts); }

  // `times`: with Timestamps::every_step; `counts`: for the stages' models.
  void add(std::span<const Step> steps, const Recorder::Times& times, const RunCounts& counts);

  struct Sum {
    std::string name;
    std::uint64_t bytes;  // of one dispatch, by the stage's model
    double ms = 0;
    std::uint32_t dispatches = 0;
  };
  const std::vector<Sum>& sums() const { return sums_; }  // in order of appearance

  // The most bytes that a dispatch moves, by its model.
  std::uint64_t largest_dispatch() const;

  bool untimed() const { return untimed_; }  // by a device without timestamps

 private:
  bool untimed_ = false;
  std::vector<Sum> sums_;
  std::map<std::pair<std::string, std::uint64_t>, std::size_t> index_;
};

// One row of the table of kernels: all dispatches of a kernel.
struct KernelTime {
  std::string name;
  double ms = 0;
  std::uint32_t dispatches = 0;
  std::uint64_t bytes = 0;            // by the stages' models
  std::optional<double> copy_ms = 0;  // what copies of the same sizes take; empty where not measured

  double gb_per_s() const { return static_cast<double>(bytes) / (ms * 1e6); }
  double percent_of_copy() const { return 100 * copy_ms.value_or(0) / ms; }
};

struct KernelTable {
  std::vector<KernelTime> rows;  // in order of appearance
  bool untimed = false;          // by a device without timestamps: nothing is known, and JSON says null
  double untimed_ms = 0;         // the same steps without a timestamp after each
  double copy_gb_per_s = 0;      // of the largest copy that was measured; 0: none

  KernelTime sum() const;
};

// Empty, with a note, where the device cannot measure it.
std::optional<CopyLimit> find_copy_limit(CheckedDevice& device, std::uint64_t most_bytes);

KernelTable kernel_table(const KernelSums& sums, const std::optional<CopyLimit>& limit, double untimed_ms);

// Rows; the sums are not among them. `sums_to_json`: timed_ms and copy_gb_per_s. Null where untimed.
void sums_to_json(const KernelTable& table, Json& json);
Json to_json(const KernelTable& table);

// Rows, their sum, and lines that say how it was measured.
std::string text_of(const KernelTable& table);

}  // namespace coppice
