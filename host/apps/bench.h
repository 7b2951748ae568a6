#pragma once

#include <functional>
#include <string>
#include <utility>

#include "apps/open_device.h"
#include "apps/report.h"
#include "apps/steady_state.h"

namespace coppice {

// One measurement: what ran, on how many, how fast. Correctness has been checked before.
struct BenchRow {
  std::string name, input;  // "sort_pairs_32" on "random"
  std::uint64_t size = 0;   // words, keys, triangles, rays
  Spread ms{};
  std::uint32_t runs = 0, warm_up_runs = 0;
  bool stable = false;
  std::vector<std::pair<std::string, double>> figures;  // more columns, each by its name
  std::string note;                                     // what is printed of them, in words
  KernelTable kernels;                                  // of one more run, with timestamps; may be empty

  double millions_per_s() const { return static_cast<double>(size) / ms.median / 1000; }
};

BenchRow bench_row(std::string name, std::string input, std::uint64_t size, const SteadyTime& time);

// A table of rows with the columns that any of them has, as RFC 4180 has it; without a line break at the end.
std::string bench_csv(const std::vector<BenchRow>& rows, const DeviceProperties& device);
Json to_json(const BenchRow& row);

// How often to measure what takes about `once_ms`: what takes long is not repeated as often.
SteadyOptions steady_options(const Options& options, double once_ms);

// Sizes from `first` by factors of four below `most`, then `most`.
std::vector<std::uint32_t> bench_sizes(std::uint32_t first, std::uint32_t most);

// Whether --only asks for it: a part of "NAME INPUT", or nothing asked for.
bool is_wanted(const Options& options, const std::string& name, const std::string& input);

// Each checks the result first, against the host's, and throws DeviceError if it is wrong. Hands over every
// row as it is done.
using AddRow = std::function<void(BenchRow)>;
void bench_sort(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_scan(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_ploc(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_build(CheckedDevice& device, const Options& options, const AddRow& add);
void bench_trace(CheckedDevice& device, const Options& options, const AddRow& add);

// One row of bench_sort; `count` is a multiple of 4, `preset` one of its kinds of keys.
BenchRow bench_keys(CheckedDevice& device, const Options& options, std::uint32_t count,
                    std::uint32_t key_words, bool has_values, const std::string& preset);

// One row of bench_trace, without the whole picture; Throws InputError for a scene
// that does not open.
BenchRow bench_primary_rays(CheckedDevice& device, const Options& options, Walk walk);

struct NamedBench {
  const char* name;
  void (*run)(CheckedDevice& device, const Options& options, const AddRow& add);
};
std::span<const NamedBench> benches();

}  // namespace coppice
