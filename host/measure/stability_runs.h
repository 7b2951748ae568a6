#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stability.h"
#include "measure/builder_choice.h"
#include "pipeline/checked_device.h"
#include "scene/hard_cases.h"

namespace coppice {

// The triangles of a hard case as stages take them, brought into range; coordinates are multiplied by `scale`
// before.
std::vector<Triangle> case_triangles(const HardCase& hard_case, std::uint32_t count, std::uint64_t seed,
                                     float scale = 1);

vec3 centre_of(const Node& node);

struct StabilityOptions {
  std::uint32_t most_triangles = 2000;  // cases are made no larger than this
  std::uint32_t rays = 500;             // of each kind
  std::uint64_t seed = 1;
  std::uint32_t seed_count = 1;     // from `seed` on
  std::uint64_t leak_rays = 20000;  // of each closed mesh at each of five scales; 0: none
  BuilderChoice builder{};          // for the builds of gpu-ploc
};

// Builds the hard case on the device and by the twins in lockstep, then traces every kind of hard rays with
// every variant by both, and judges the device's hits.
StabilityCase examine_case(CheckedDevice& device, const HardCase& hard_case, const StabilityOptions& options);

struct ExaminedCases {
  std::vector<StabilityCase> rows{};  // of more seeds than one only those that fail
  std::uint64_t examined = 0, failed = 0;
  KindSums kinds{};
};

// All of them, with every seed.
ExaminedCases examine_cases(CheckedDevice& device, std::span<const HardCase* const> cases,
                            const StabilityOptions& options);

// Shoots options.leak_rays rays at corners, edges and inner points of each closed one of the cases, at scales
// from 1e-6 to 1e6, from random points around its centre.
std::vector<LeakCount> count_leaks(CheckedDevice& device, std::span<const HardCase* const> cases,
                                   const StabilityOptions& options);

// The time of rays with a NaN as a multiple of that of random rays; median of five pairs of runs.
double cost_of_nan_rays(CheckedDevice& device);

}  // namespace coppice
