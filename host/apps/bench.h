#pragma once

#include <functional>
#include <string>

#include "apps/checked_device.h"
#include "apps/report.h"
#include "apps/steady_state.h"

namespace coppice {

// One measurement: what ran, on how many, how fast. Correctness has been checked before.
struct BenchRow {
  std::string name, input;  // "sort_pairs_32" on "random"
  std::uint64_t size = 0;   // keys, triangles, rays
  Spread ms{};
  std::uint32_t runs = 0, warm_up_runs = 0;
  bool stable = false;
  double scratch_bytes = 0;  // of a build: device memory a triangle, beside triangles and nodes

  double millions_per_s() const { return static_cast<double>(size) / ms.median / 1000; }
};

BenchRow bench_row(std::string name, std::string input, std::uint64_t size, const SteadyTime& time);

// Sizes from `first` by factors of four below `most`, then `most`.
std::vector<std::uint32_t> bench_sizes(std::uint32_t first, std::uint32_t most);

// Each checks the result first, against the host's: std::stable_sort, the builder ploc, the twins. Throws
// DeviceError if it is wrong. Hands over every row as it is done.
using AddRow = std::function<void(const BenchRow&)>;
void bench_sort(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_build(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_trace(CheckedDevice& device, const Options& options, const AddRow& add);

// One row of bench_sort; `count` is a multiple of 4, `preset` one of its kinds of keys.
BenchRow bench_pairs(CheckedDevice& device, const Options& options, std::uint32_t count,
                     std::uint32_t key_words, const std::string& preset);

}  // namespace coppice
