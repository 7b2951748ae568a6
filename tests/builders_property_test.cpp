// Random scenes: every CPU builder gives a valid tree, and through it the hits of brute force.
#include <gtest/gtest.h>

#include <glm/common.hpp>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "analysis/validate.h"
#include "builders/registry.h"
#include "support/random_scenes.h"

namespace coppice {
namespace {

// Half of them at a point of a triangle, the others anywhere; some along an axis, some cut short.
std::vector<Ray> random_rays(std::span<const Triangle> triangles, Random& random, std::uint32_t count) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    const Triangle& aim = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float u = random.uniform(), v = random.uniform() * (1 - u);
    vec3 direction = random.below(2) == 0 ? random.direction() : random.in_cube();
    if (random.below(4) == 0) direction[static_cast<int>(random.below(3))] = 0;
    const vec3 target = aim.a * (1 - u - v) + aim.b * u + aim.c * v;
    const vec3 extent = glm::abs(aim.a) + glm::abs(aim.b) + glm::abs(aim.c);
    const float length = std::max({extent.x, extent.y, extent.z, 1e-30f});
    ray.origin = random.below(2) == 0 ? target - direction * length : random.in_cube() * length;
    ray.direction = direction;
    ray.t_max = random.below(4) == 0 ? length : std::numeric_limits<float>::infinity();
  }
  return rays;
}

TEST(BuildersProperty, ValidTreesAndTheHitsOfBruteForce) {
  std::uint64_t hit_count = 0;
  for_random_scenes(300, [&](RandomScene& scene) {
    Random& random = scene.random();
    const BuilderConfig config{1 + random.below(16), random.below(2) == 0 ? 30u : 60u};
    const std::vector<Triangle> triangles = scene.triangles(1 + random.below(300));
    const std::vector<Ray> rays = random_rays(triangles, random, 64);
    std::vector<Hit> by_force(rays.size()), by_tree(rays.size());
    trace_all({}, triangles, rays, by_force);
    hit_count += std::ranges::count_if(by_force, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; });
    for (const CpuBuilder& builder : cpu_builders()) {
      if (builder.name == "none") continue;
      const Bvh bvh = builder.build(triangles, config);
      const TreePromises promises{builder.splits_triangles, !builder.splits_triangles};
      EXPECT_EQ(find_fault(bvh.nodes, triangles, promises), std::nullopt) << builder.name;
      if (bvh.nodes.empty()) continue;
      trace_all(bvh.nodes, triangles, rays, by_tree);
      EXPECT_EQ(compare_hits(by_tree, by_force).count, 0u) << builder.name;
    }
  });
  EXPECT_GT(hit_count, 0u);
}

}  // namespace
}  // namespace coppice
