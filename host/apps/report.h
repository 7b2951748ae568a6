#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/quality.h"
#include "analysis/wide_tree.h"
#include "apps/kernel_times.h"
#include "apps/options.h"
#include "apps/ploc_rounds.h"

namespace coppice {

struct Spread {
  double median, least, greatest;
};
Spread spread_of(std::vector<double> values);

// What a build reports, whoever built. Kernels only for GPU builders.
struct BuildReport {
  std::string scene, builder, device, driver;
  std::string variants;  // of stages on the device
  bool lookback = false;
  std::uint64_t triangles = 0, inactive = 0;
  glm::dvec3 offset{0.0};  // that the reader subtracted from all coordinates of the file
  std::uint32_t radius = 0, morton_bits = 0, leaf_size = 0;
  Spread build_ms{}, wall_ms{};
  std::uint32_t runs = 0;
  KernelTable kernels;
  std::vector<PlocRoundTime> ploc_rounds;  // empty unless asked for
  std::uint32_t rounds = 0, rounds_bound = 0;
  TreeQuality quality{};
  std::uint64_t tree_hash = 0;
  std::uint64_t device_bytes = 0;
  bool reference_cap_reached = false;  // spatial splits ran out of references
  Spread wide_ms{};                    // of the conversion to wide nodes, by itself
  WideQuality wide{};                  // no nodes: no conversion
};
Json to_json(const BuildReport& report);
Json coordinates(glm::dvec3 point);
void print_build(const BuildReport& report);

// Writes to the file, or to stdout for "-"; nothing for "". Bytes of names that are no UTF-8 become U+FFFD.
// Throws InputError naming the file.
void write_json(const std::string& path, const Json& json);

// Chrome trace events of timed runs, one behind the other.
class TraceEvents {
 public:
  // A viewer takes no more, and neither does memory: what comes later is left out, which stderr is told.
  static constexpr std::size_t most_events = 1u << 20;

  void add(std::span<const Step> steps, const Recorder::Times& times);
  void add(const KernelSplit& split) { add(split.steps, split.times); }

  // Throws InputError naming the file; nothing for "".
  void write(const std::string& path) const;

 private:
  struct Event {
    const char* name;
    double ms;
  };
  std::vector<Event> events_;
  std::uint64_t left_out_ = 0;
};

// Whether the human-readable report may go to stdout.
inline bool talks(const Options& options) { return options.json != "-"; }

}  // namespace coppice
