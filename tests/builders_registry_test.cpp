// Every builder that the commands know gives a valid tree on every hard case, and the same closest hits.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "analysis/validate.h"
#include "builders/registry.h"
#include "render/frame.h"
#include "scene/generators.h"
#include "scene/hard_cases.h"
#include "support/rays.h"

namespace coppice {
namespace {

#ifdef COPPICE_SANITIZED
constexpr std::uint32_t RAYS_A_BUILDER = 2000;
#else
constexpr std::uint32_t RAYS_A_BUILDER = 20000;
#endif

class EveryBuilder : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryBuilder, GivesAValidTreeOnEveryHardCase) {
  const CpuBuilder& builder = find_cpu_builder(GetParam());
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 3000u);
    const auto triangles = scene_arrays(hard_case.make(count, 1)).triangles;
    const Bvh bvh = builder.build(triangles, {});
    const TreePromises promises{builder.splits_triangles, !builder.splits_triangles};
    EXPECT_EQ(find_fault(bvh.nodes, triangles, promises), std::nullopt) << hard_case.name;
  }
}

TEST_P(EveryBuilder, GivesTheHitsOfBruteForce) {
  const auto triangles = scene_arrays(make_scatter(2000)).triangles;
  const Bvh bvh = find_cpu_builder(GetParam()).build(triangles, {});
  std::vector<Ray> rays = rays_around(triangles, RAYS_A_BUILDER, 1);
  const std::vector<Ray> at_edges = rays_at_edges(triangles, RAYS_A_BUILDER / 4, 2);
  rays.insert(rays.end(), at_edges.begin(), at_edges.end());
  std::vector<Hit> by_tree(rays.size()), by_force(rays.size());
  trace_all(bvh.nodes, triangles, rays, by_tree);
  trace_all({}, triangles, rays, by_force);
  EXPECT_EQ(compare_hits(by_tree, by_force).count, 0u);
  EXPECT_GT(std::ranges::count_if(by_force, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; }),
            RAYS_A_BUILDER / 5);
}

std::vector<std::string_view> tree_builders() {
  std::vector<std::string_view> names;
  for (const CpuBuilder& builder : cpu_builders()) {
    if (builder.name != "none") names.push_back(builder.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Builders, EveryBuilder, testing::ValuesIn(tree_builders()), [](const auto& info) {
  std::string name(info.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace coppice
