#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/judge_hits.h"
#include "apps/open_device.h"
#include "apps/ray_example.h"
#include "scene/hard_cases.h"

namespace coppice {

// A choice of intersection tests.
struct IntersectionVariant {
  std::string_view triangle, box;  // as the command line names them
  std::uint32_t triangle_test, box_test;
};

// All four, fast first.
const std::vector<IntersectionVariant>& intersection_variants();

// What one kind of rays found with one variant.
struct RayResult {
  std::string_view kind;
  HitVerdicts verdicts{};
  std::uint64_t leaks = 0;             // misses of rays from inside of a closed mesh
  std::vector<RayExample> examples{};  // one of each kind of failure, the gravest first

  // Of the first example, on one line; empty where nothing failed.
  std::string example() const { return examples.empty() ? "" : described(examples.front()); }
};

struct VariantResult {
  const IntersectionVariant* variant;
  std::vector<RayResult> kinds;
  bool bits_equal = false;  // the device's hits are the twins'
  std::string error;        // that the trace ended with; then no ray is judged

  // Of the examples the first of each kind of failure.
  RayResult total() const;
};

struct StabilityCase {
  std::string scene;
  std::uint64_t seed = 1;
  std::uint64_t triangles = 0;
  std::uint32_t rounds = 0, rounds_bound = 0, depth = 0;
  std::string fault;             // of the device's tree; empty: valid
  std::string difference;        // first one between device and twins in the build; empty: bits equal
  bool same_as_builder = false;  // the independent builder's tree has the same bits
  std::vector<VariantResult> variants;

  // Whether the build is sound and the most accurate variant loses and invents no hit.
  bool passes() const;
};

// The triangles of a hard case as stages take them, brought into range; coordinates are multiplied by `scale`
// before.
std::vector<Triangle> case_triangles(const HardCase& hard_case, std::uint32_t count, std::uint64_t seed,
                                     float scale = 1);

vec3 centre_of(const Node& node);

struct StabilityOptions {
  std::uint32_t most_triangles = 2000;  // cases are made no larger than this
  std::uint32_t rays = 500;             // of each kind
  std::uint64_t seed = 1;
};

// Builds the hard case on the device and by the twins in lockstep, then traces every kind of hard rays with
// every variant by both, and judges the device's hits.
StabilityCase examine_case(CheckedDevice& device, const HardCase& hard_case, const Options& options,
                           const StabilityOptions& stability);

// Rays from inside of a closed mesh that must all hit.
struct LeakCount {
  std::string mesh;
  double scale;
  const IntersectionVariant* variant;
  std::uint64_t rays = 0, leaks = 0;
  double seconds = 0;
  std::string example{};  // of a leak
};

// Shoots `rays` rays at corners, edges and inner points of each closed one of the cases, at scales from 1e-6
// to 1e6, from random points around its centre.
std::vector<LeakCount> count_leaks(CheckedDevice& device, std::span<const HardCase* const> cases,
                                   std::uint64_t rays, const Options& options,
                                   const StabilityOptions& stability);

// The time of rays with a NaN as a multiple of that of random rays; median of five pairs of runs.
double cost_of_nan_rays(CheckedDevice& device, const Options& options);

}  // namespace coppice
