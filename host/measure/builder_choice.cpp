#include "measure/builder_choice.h"

#include "builders/morton_crowding.h"

namespace coppice {

std::uint32_t BuilderChoice::bits_for(std::span<const Triangle> triangles) const {
  return morton_bits ? morton_bits : choose_morton_bits(triangles);
}

BuildOptions BuilderChoice::build_options(std::uint32_t bits) const {
  BuildOptions build;
  build.radius = radius;
  build.morton_bits = bits;
  if (const NamedDeviceBuilder* const named = on_device()) build.builder = named->builder;
  return build;
}

}  // namespace coppice
