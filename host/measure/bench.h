#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "measure/builder_choice.h"
#include "measure/kernel_times.h"
#include "measure/steady_state.h"
#include "measure/table.h"
#include "pipeline/checked_device.h"
#include "pipeline/trace_plan.h"
#include "scene/scene_source.h"

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

// What the benches measure, and how often.
struct BenchOptions {
  std::uint32_t most = 1u << 20;                  // words, keys or triangles of the largest size
  std::uint32_t runs = 5;                         // that count, after a warm-up
  std::vector<std::string> only{};                // parts of names of rows; empty: all
  std::vector<std::string> scenes{}, builders{};  // empty: the default ones
  BuilderChoice builder{};                        // of what has one builder
  std::string up = "y";                           // of the scenes
  TraceOptions trace{};                           // of the trace
  std::vector<double> camera{};
};

// A table for rows, to which columns come as rows have more figures.
Table bench_table();
const Row& add_row(Table& table, const BenchRow& row);

// All of them, with where and when they were measured.
std::string csv_of(Table table, const DeviceProperties& device);

// The rows of the table of these rows, each with what its kernels took.
Json to_json(const Table& table, std::span<const BenchRow> rows);

// How often to measure what takes about `once_ms`: what takes long is not repeated as often.
SteadyOptions steady_options(const BenchOptions& options, double once_ms);

// Sizes from `first` by factors of four below `most`, then `most`.
std::vector<std::uint32_t> bench_sizes(std::uint32_t first, std::uint32_t most);

// Whether options.only asks for it: a part of "NAME INPUT", or nothing asked for.
bool is_wanted(const BenchOptions& options, const std::string& name, const std::string& input);

// Each checks the result first, against the host's, and throws DeviceError if it is wrong. Hands over every
// row as it is done.
using AddRow = std::function<void(BenchRow)>;
void bench_sort(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_scan(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_ploc(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_build(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_refit(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_trace(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
void bench_instances(CheckedDevice& device, const BenchOptions& options, const AddRow& add);

// One row of bench_sort; `count` is a multiple of 4, `preset` one of its kinds of keys.
BenchRow bench_keys(CheckedDevice& device, const BenchOptions& options, std::uint32_t count,
                    std::uint32_t key_words, bool has_values, const std::string& preset);

// One row of bench_trace, without the whole picture. Throws InputError for a scene that does not open.
BenchRow bench_primary_rays(CheckedDevice& device, const BenchOptions& options, const SceneOptions& scene,
                            Walk walk);

struct NamedBench {
  const char* name;
  void (*run)(CheckedDevice& device, const BenchOptions& options, const AddRow& add);
};
std::span<const NamedBench> benches();

}  // namespace coppice
