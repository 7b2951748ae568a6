// Embree, a tracer that shares nothing with ours, finds the same closest hits in the same triangles.
#include <gtest/gtest.h>

#include <string>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "builders/registry.h"
#include "scene/generators.h"
#include "support/embree_scene.h"
#include "support/hit_referee.h"
#include "support/rays.h"
#include "support/split_trees.h"
#include "support/triangles.h"

namespace coppice {
namespace {

#ifdef COPPICE_SANITIZED
constexpr std::uint32_t RAY_COUNT = 50'000;
#else
constexpr std::uint32_t RAY_COUNT = 1'000'000;
#endif

struct Subject {
  const char* scene;
  std::vector<Triangle> (*make)();
  std::vector<const char*> builders;
};

void PrintTo(const Subject& subject, std::ostream* out) { *out << subject.scene; }

class Embree : public testing::TestWithParam<Subject> {
 protected:
  // Judges the hits of the first builder's tree by Embree's. The other builders' trees must give the first
  // one's, bit for bit.
  Verdicts judge(std::span<const Triangle> triangles, std::span<const Ray> rays) const {
    std::vector<Hit> hits(rays.size()), first;
    for (const char* builder : GetParam().builders) {
      trace_all(find_cpu_builder(builder).build(triangles, {}).nodes, triangles, rays, hits);
      if (first.empty()) first = hits;
      EXPECT_EQ(compare_hits(hits, first).count, 0u) << builder;
    }
    const std::vector<Hit> expected = EmbreeScene(triangles).trace(rays);
    const Verdicts verdicts = judge_all(triangles, rays, first, expected);
    RecordProperty("hits", std::to_string(verdicts.hits));
    RecordProperty("ties", std::to_string(verdicts.ties));
    RecordProperty("borderline", std::to_string(verdicts.borderline));
    const std::size_t i = verdicts.first_wrong;
    EXPECT_EQ(verdicts.wrong, 0u) << "ray " << i << ": triangle " << first[i].triangle << " at " << first[i].t
                                  << ", Embree: " << expected[i].triangle << " at " << expected[i].t;
    return verdicts;
  }
};

TEST_P(Embree, FindsTheSameHits) {
  const std::vector<Triangle> triangles = GetParam().make();
  const std::vector<Ray> rays = rays_around(triangles, RAY_COUNT, 1);
  const Verdicts verdicts = judge(triangles, rays);
  EXPECT_GT(verdicts.hits, rays.size() / 20);
  EXPECT_LE(verdicts.disputed(), rays.size() / 10'000);
}

// Here many rays meet two triangles at once, and float decides whether others meet one at all.
TEST_P(Embree, FindsTheSameHitsAtEdgesButForRounding) {
  const std::vector<Triangle> triangles = GetParam().make();
  const std::vector<Ray> rays = rays_at_edges(triangles, RAY_COUNT / 20, 2);
  const Verdicts verdicts = judge(triangles, rays);
  EXPECT_GT(verdicts.hits, rays.size() / 4);
  EXPECT_GT(verdicts.disputed(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Embree,
    testing::Values(
        Subject{"scatter", [] { return triangles_of(make_scatter(20'000)); }, {"sah", "sah-sweep", "ploc"}},
        Subject{"terrain",
                [] { return triangles_of(make_terrain(20'000)); },
                {"lbvh", "bottom-up", "gd16-early"}},
        Subject{"grove", [] { return triangles_of(make_grove()); }, {"ploc-parallel", "top-down"}},
        Subject{"needles", [] { return needles(2'000, 9); }, {"sbvh", "gd16"}}),
    [](const auto& test) { return std::string(test.param.scene); });

}  // namespace
}  // namespace coppice
