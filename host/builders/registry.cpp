#include "builders/registry.h"

#include <stdexcept>
#include <string>

#include "builders/bottom_up.h"
#include "builders/gd16.h"
#include "builders/hploc.h"
#include "builders/lbvh.h"
#include "builders/ploc.h"
#include "builders/ploc_parallel.h"
#include "builders/sah.h"
#include "builders/sah_sweep.h"
#include "builders/sbvh.h"
#include "builders/top_down.h"

namespace coppice {

std::span<const CpuBuilder> cpu_builders() {
  using Triangles = std::span<const Triangle>;
  using Config = const BuilderConfig&;
  static constexpr CpuBuilder builders[] = {
      {"none", "brute force, no tree", [](Triangles, Config) { return Bvh{}; }, false},
      {"top-down", "middle of the longest axis", [](Triangles t, Config) { return build_top_down(t); },
       false},
      {"bottom-up", "neighbours in list order, level by level",
       [](Triangles t, Config) { return build_bottom_up(t); }, false},
      {"sah", "Wald 2007, binned object splits", [](Triangles t, Config) { return build_sah(t); }, false},
      {"sah-sweep", "full sweep of object splits", [](Triangles t, Config) { return build_sah_sweep(t); },
       false},
      {"gd16", "Ganestam and Doggett 2016, spatial splits", [](Triangles t, Config) { return build_gd16(t); },
       true},
      {"gd16-early", "the same with early termination",
       [](Triangles t, Config c) {
         return build_gd16(t, {.early_termination = true, .leaf_references = c.leaf_size});
       },
       true},
      {"sbvh", "Stich, Friedrich and Dietrich 2009, spatial splits",
       [](Triangles t, Config) { return build_sbvh(t); }, true},
      {"lbvh", "linear BVH",
       [](Triangles t, Config c) { return build_lbvh(t, {.morton_bits = c.morton_bits}); }, false, true},
      {"ploc", "Meister and Bittner 2018, sequential",
       [](Triangles t, Config c) {
         return build_ploc(t, {c.radius, c.morton_bits});
       },
       false, true},
      {"hploc", "Benthin et al. 2024, sequential",
       [](Triangles t, Config c) {
         return build_hploc(t, {c.radius, c.morton_bits});
       },
       false, true},
      {"ploc-parallel", "Meister and Bittner 2018, all threads",
       [](Triangles t, Config c) {
         return build_ploc_parallel(t, {.radius = c.radius, .morton_bits = c.morton_bits});
       },
       false, true},
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
