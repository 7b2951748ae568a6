#pragma once

#include <span>
#include <string_view>

#include "builders/bvh.h"

namespace coppice {

// What the command line can choose, for builders that have the choice.
struct BuilderConfig {
  std::uint32_t radius = 16;
  std::uint32_t morton_bits = 30;
  std::uint32_t leaf_size = 8;  // of gd16-early: the most references that are not split any further
};

// A CPU builder as the commands know it.
struct CpuBuilder {
  std::string_view name;
  std::string_view paper;  // where its idea stands
  Bvh (*build)(std::span<const Triangle> triangles, const BuilderConfig& config);
  bool splits_triangles;           // a triangle may stand in several leaves
  bool uses_morton_codes = false;  // so BuilderConfig::morton_bits matters
};

// All of them, in the order in which tables list them; "none" builds no tree.
std::span<const CpuBuilder> cpu_builders();

// Throws std::invalid_argument for a name that is none of them.
const CpuBuilder& find_cpu_builder(std::string_view name);

}  // namespace coppice
