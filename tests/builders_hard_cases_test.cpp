#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "builders/bottom_up.h"
#include "builders/lbvh.h"
#include "builders/ploc_parallel.h"
#include "builders/sah.h"
#include "builders/sah_sweep.h"
#include "builders/subtree.h"
#include "builders/top_down.h"
#include "scene/hard_cases.h"
#include "support/builders.h"
#include "support/triangles.h"

namespace coppice {
namespace {

struct Builder {
  const char* name;
  Bvh (*build)(std::span<const Triangle>);
};

const Builder BUILDERS[] = {
    {"bottom_up", build_bottom_up},
    {"lbvh",
     [](std::span<const Triangle> triangles) {
       return build_lbvh(triangles, {30, 2});
     }},
    {"lbvh_60",
     [](std::span<const Triangle> triangles) {
       return build_lbvh(triangles, {60, 2});
     }},
    {"ploc_parallel",
     [](std::span<const Triangle> triangles) {
       return build_ploc_parallel(triangles, {16, 30, 2});
     }},
    {"sah", [](std::span<const Triangle> triangles) { return build_sah(triangles, {2}); }},
    {"sah_sweep", build_sah_sweep},
    {"top_down", build_top_down},
};

class BuildersOnHardCases : public testing::TestWithParam<HardCase> {
 protected:
  // Calls check(tree, triangles) for the tree of every builder.
  static void check_trees(std::uint32_t count, auto&& check) {
    const std::vector<Triangle> triangles = triangles_of(GetParam().make(count, 1));
    for (const Builder& builder : BUILDERS) {
      SCOPED_TRACE(std::string(builder.name) + " of " + std::to_string(count) + " triangles");
      check(builder.build(triangles), triangles);
    }
  }
};

TEST_P(BuildersOnHardCases, GiveValidTrees) {
  constexpr std::uint32_t most = 20000;
  check_trees(std::min(most, GetParam().default_triangle_count), expect_valid);
}

TEST_P(BuildersOnHardCases, GiveValidTreesOfFewTriangles) {
  for (std::uint32_t count = 0; count <= 9; ++count) check_trees(count, expect_valid);
}

TEST_P(BuildersOnHardCases, CountTheActiveTriangles) {
  check_trees(100, [](const Bvh& bvh, std::span<const Triangle>) {
    EXPECT_EQ(bvh.nodes.size(), bvh.active_count == 0 ? 0 : 2 * bvh.active_count - 1);
  });
}

TEST_P(BuildersOnHardCases, KeepTreesLow) {
  constexpr std::uint32_t most = 20000;
  check_trees(most, [](const Bvh& bvh, std::span<const Triangle>) {
    EXPECT_LE(bvh.nodes.empty() ? 0 : bvh.nodes[0].height, SPLIT_HEIGHT_LIMIT);
  });
}

std::string name_of(const testing::TestParamInfo<HardCase>& info) {
  std::string name(info.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, BuildersOnHardCases,
                         testing::ValuesIn(hard_cases().begin(), hard_cases().end()), name_of);

}  // namespace
}  // namespace coppice
