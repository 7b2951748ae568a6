#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/quality.h"
#include "apps/options.h"
#include "gpu/recorder.h"
#include "stages/gpu_executor.h"

namespace coppice {

using Json = nlohmann::ordered_json;

struct KernelTime {
  std::string name;
  double ms;
  std::uint32_t dispatches;
};

// Sums the times of a recording with Timestamps::every_step by kernel, in order of appearance.
std::vector<KernelTime> kernel_times(std::span<const Step> steps, const Recorder::Times& times);
Json to_json(std::span<const KernelTime> kernels);
void print_kernels(std::span<const KernelTime> kernels);

// The steps without the marks, and without the indirect dispatches that the last run found empty: timestamps
// around those would measure the timestamps.
std::vector<Step> measurable_steps(const GpuExecutor& executor, std::span<const Step> steps);

struct Spread {
  double median, least, greatest;
};
Spread spread_of(std::vector<double> values);

// What a build reports, whoever built. Kernels and dispatches only for GPU builders.
struct BuildReport {
  std::string scene, builder, device, driver;
  std::uint64_t triangles = 0, inactive = 0;
  std::uint32_t radius = 0, morton_bits = 0, leaf_size = 0;
  Spread build_ms{}, wall_ms{};
  std::uint32_t runs = 0;
  std::vector<KernelTime> kernels;
  std::uint32_t dispatches = 0, rounds = 0, rounds_bound = 0;
  TreeQuality quality{};
  std::uint64_t tree_hash = 0;
  std::uint64_t device_bytes = 0;
  bool reference_cap_reached = false;  // spatial splits ran out of references
};
Json to_json(const BuildReport& report);
void print_build(const BuildReport& report);

// Throws InputError naming the file.
void write_text(const std::string& path, const std::string& text);

// Writes to the file, or to stdout for "-"; nothing for "". Throws InputError naming the file.
void write_json(const std::string& path, const Json& json);

// Chrome trace events of a timed run. Throws InputError naming the file.
void write_trace_events(const std::string& path, std::span<const Step> steps, const Recorder::Times& times);

// Whether the human-readable report may go to stdout.
inline bool talks(const Options& options) { return options.json != "-"; }

}  // namespace coppice
