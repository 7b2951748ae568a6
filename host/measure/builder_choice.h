#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "builders/registry.h"
#include "pipeline/build_plan.h"

namespace coppice {

// Which builder makes a tree, on the device or the host, and how.
struct BuilderChoice {
  std::string name = "gpu-ploc";
  std::uint32_t radius = 16;
  std::uint32_t leaf_size = 8;    // of gd16-early
  std::uint32_t morton_bits = 0;  // 30 or 60; 0: what the scene calls for

  const NamedDeviceBuilder* on_device() const { return find_device_builder(name); }

  // As said, or else what the scene calls for (choose_morton_bits): the same for builders on the device and
  // on the host. `triangles`: those of scene_arrays.
  std::uint32_t bits_for(std::span<const Triangle> triangles) const;

  // Of a build on the device, but for what the device says itself.
  BuildOptions build_options(std::uint32_t bits) const;
  BuildOptions build_options(std::span<const Triangle> triangles) const {
    return build_options(bits_for(triangles));
  }
  // Before the triangles are known: with the shorter codes, if they may be.
  BuildOptions least_build_options() const { return build_options(morton_bits == 60 ? 60 : 30); }
};

}  // namespace coppice
