#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "analysis/quality.h"
#include "analysis/wide_tree.h"
#include "measure/kernel_times.h"
#include "measure/round_times.h"
#include "measure/steady_state.h"

namespace coppice {

// What a build reports, whoever built. Kernels only for GPU builders.
struct BuildReport {
  std::string scene, builder, device, driver;
  std::string variants;  // of stages on the device
  bool lookback = false;
  std::uint64_t triangles = 0, inactive = 0;
  std::uint64_t instances = 0;  // of meshes that have these triangles; then the tree is over instances
  glm::dvec3 offset{0.0};       // that the reader subtracted from all coordinates of the file
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
std::string text_of(const BuildReport& report);

}  // namespace coppice
