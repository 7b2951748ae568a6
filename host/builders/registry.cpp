#include "builders/registry.h"

#include <stdexcept>
#include <string>

#include "builders/ploc.h"

namespace coppice {

std::span<const CpuBuilder> cpu_builders() {
  using Triangles = std::span<const Triangle>;
  using Config = const BuilderConfig&;
  static constexpr CpuBuilder builders[] = {
      {"none", "brute force", [](Triangles, Config) { return Bvh{}; }, false},
      {"ploc", "Meister and Bittner 2018, sequential",
       [](Triangles triangles, Config config) {
         return build_ploc(triangles, {config.radius, config.morton_bits});
       },
       false},
  };
  return builders;
}

const CpuBuilder& find_cpu_builder(std::string_view name) {
  for (const CpuBuilder& builder : cpu_builders()) {
    if (builder.name == name) return builder;
  }
  throw std::invalid_argument("unknown builder '" + std::string(name) + "'");
}

}  // namespace coppice
