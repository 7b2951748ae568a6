// Packets and single rays through the wide tree find, bit for bit, what rays find in the binary tree it was
// made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "analysis/compare.h"
#include "analysis/hard_rays.h"
#include "builders/ploc.h"
#include "measure/traffic.h"
#include "pipeline/ray_tracing.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"
#include "support/lockstep.h"

namespace coppice {
namespace {

class TraceWide : public DeviceTest, public testing::WithParamInterface<Walk> {
 protected:
  static TraceOptions options_for(Walk walk) {
    TraceOptions options = test_trace_options(1, 1);
    options.walk = walk;
    options.max_turns = std::min(options.max_turns, 1u << 20);  // a walk that does not end fails
    return options;
  }

  // How many of the rays hit.
  static std::uint64_t expect_same_hits(std::span<const Triangle> triangles, std::span<const Ray> rays,
                                        const std::string& what) {
    const Bvh bvh = build_ploc(triangles, {});
    RayTracing tracing(test_device(), bvh.nodes, triangles, static_cast<std::uint32_t>(rays.size()), true);
    const TracedRays binary = tracing.on_device(rays, options_for(Walk::binary));
    const TracedRays wide = tracing.on_device(rays, options_for(GetParam()));
    EXPECT_EQ(binary.error_word, 0u) << what;
    EXPECT_EQ(wide.error_word, 0u) << what << ": " << describe_error_word(wide.error_word);
    EXPECT_EQ(compare_hits(binary.hits, wide.hits).count, 0u) << what;
    EXPECT_EQ(compare_hits(tracing.by_twins(rays, options_for(GetParam())).hits, wide.hits).count, 0u)
        << what;
    EXPECT_EQ(binary.hit_count, wide.hit_count) << what;
    return wide.hit_count;
  }

  // Of all kinds, so that packets hold rays of one kind, and then so that they hold rays of all.
  static std::vector<Ray> all_kinds(std::span<const Triangle> triangles, std::span<const Node> nodes,
                                    std::uint32_t count) {
    std::vector<Ray> rays;
    for (const RayKindName& kind : ray_kinds()) {
      const std::vector<Ray> more = hard_rays(kind.kind, triangles, nodes, count, 1);
      rays.insert(rays.end(), more.begin(), more.end());
    }
    std::vector<Ray> mixed = rays;
    std::ranges::shuffle(mixed, std::mt19937(1));
    rays.insert(rays.end(), mixed.begin(), mixed.end());
    return rays;
  }
};

TEST_P(TraceWide, HardRaysAtHardCases) {
  std::uint64_t hit_count = 0;
  for (const std::string_view name : hard_case_names()) {
    Scene scene = find_hard_case(std::string(name))->make(500, 1);
    bring_into_range(scene);
    const std::vector<Triangle> triangles = scene_arrays(scene).triangles;
    const Bvh bvh = build_ploc(triangles, {});
    hit_count += expect_same_hits(triangles, all_kinds(triangles, bvh.nodes, 70), std::string(name));
  }
  EXPECT_GT(hit_count, 10000u);
}

TEST_P(TraceWide, FewRaysAndFewTriangles) {
  for (std::uint32_t count = 0; count <= 20; ++count) {
    const std::vector<Triangle> triangles = random_triangles(count, count, 0.5f);
    const std::vector<Ray> rays = hard_rays(RayKind::VERTICES, triangles, {}, 130, count);
    for (const std::size_t ray_count : {1, 63, 64, 65, 130})
      expect_same_hits(triangles, std::span(rays).first(ray_count),
                       std::to_string(count) + " triangles, " + std::to_string(ray_count) + " rays");
  }
}

// Rays that have a hit already, some of them closer than what the tree holds.
TEST_P(TraceWide, EarlierHitsStay) {
  const std::vector<Triangle> triangles = random_triangles(5000, 3, 0.1f);
  std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 1000, 4);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_max = static_cast<float>(i % 10) * 0.1f;
  EXPECT_GT(expect_same_hits(triangles, rays, "short rays"), 100u);
}

// Hits behind the origin count where the range says so.
TEST_P(TraceWide, RangesThatBeginBehindTheOrigin) {
  const std::vector<Triangle> triangles = random_triangles(2000, 3, 0.1f);
  std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 1000, 4);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_min =
        i % 10 == 0 ? -std::numeric_limits<float>::infinity() : -0.3f * static_cast<float>(i % 10);
    if (i % 3 == 0) rays[i].t_max = -0.1f;
  }
  EXPECT_GT(expect_same_hits(triangles, rays, "from behind"), 100u);
}

// The distance of such an end is none of a plane of the scene, whichever bits it has.
TEST_P(TraceWide, RangesThatEndBeforeTheScene) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < 7; ++i) {
    const float x = 0.1f * static_cast<float>(i);
    triangles.push_back({{x, 0, 0}, {x + 0.1f, 0, 0.1f}, {x, 1, 1}});
  }
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const float step = 1e-4f * static_cast<float>(i);
    rays.push_back({{0.35f, 0.5f, -100}, 0, {0, 0, 1}, 96 + step});
    rays.push_back({{0.35f, 0.5f, -1}, -infinity, {0, 0, 1}, -5 + step});
  }
  EXPECT_EQ(expect_same_hits(triangles, rays, "ends before the scene"), 0u);
}

// Too far away for distances to the planes of a grid; not moved closer either.
TEST_P(TraceWide, OriginsBeyondAllScenes) {
  const std::vector<Triangle> triangles = random_triangles(2000, 3, 0.1f);
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) {
    const float x = 0.01f * static_cast<float>(i);
    rays.push_back({{x, 1 - x, i % 2 == 0 ? -0x1p110f : -0x1p70f}, 0, {0, 0, 1}, 0x1p126f});
  }
  EXPECT_GT(expect_same_hits(triangles, rays, "from very far"), 10u);
}

// Camera rays, which fill packets as they are meant to be filled: all buffers, the count of visited nodes
// with them.
TEST_P(TraceWide, APictureInLockstep) {
  struct Picture {
    uvec2 size;
    std::uint32_t samples;
  };
  for (const auto [size, samples] : {Picture{{1, 1}, 2}, Picture{{1, 1}, 1}, Picture{{19, 13}, 2},
                                     Picture{{19, 13}, 1}, Picture{{64, 48}, 1}, Picture{{200, 7}, 2}}) {
    const std::vector<Triangle> triangles = random_triangles(3000, 5, 0.1f);
    TraceOptions options = test_trace_options(size.x, size.y);
    options.walk = GetParam();
    options.samples = samples;
    Layout layout(test_device().properties().max_block_bytes);
    BuildPlan build = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), {});
    const WidePlan wide = plan_wide(layout, build, &build);
    const TracePlan trace = plan_trace(layout, build, 1, options);
    LockstepExecutor executor(test_device(), layout);
    SceneArrays arrays;
    arrays.triangles = triangles;
    arrays.material_index.resize(triangles.size());
    arrays.materials = {{vec3(0.1f), vec3(0.8f)}};
    arrays.lighting = {vec3(0, 0, -1), 0, vec3(0.9f), 0, vec3(0.3f, 0.5f, 0.9f), 0};
    Film film{
        vec3(0.5f, 0.5f, -2), size.x, vec3(-0.5f, 0.5f, 2), size.y, {}, options.samples, {}, 0, {}, 0, {}, 0};
    film.right = vec3(1.0f / static_cast<float>(size.x), 0, 0);
    film.down = vec3(0, -1.0f / static_cast<float>(size.y), 0);
    upload_frame(executor, build, trace, arrays, film);
    const auto difference = executor.run([&](Chain& chain) {
      append_build(chain, build);
      append_wide(chain, build, wide);
      append_trace(chain, build, trace);
    });
    ASSERT_FALSE(difference) << "stage " << difference->stage << ", " << difference->slot << "["
                             << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                             << difference->gpu;
    const RunCounts counts = counts_of_trace(executor.gpu().read(trace.counters)[0]);
    EXPECT_EQ(counts.rays, samples * size.x * size.y);
    EXPECT_GE(counts.steps, counts.hits);
  }
}

TEST_P(TraceWide, TooFewTurnsAreReportedByName) {
  const std::vector<Triangle> triangles = random_triangles(5000, 3, 0.1f);
  const std::vector<Ray> rays = hard_rays(RayKind::VERTICES, triangles, {}, 100, 4);
  const Bvh bvh = build_ploc(triangles, {});
  RayTracing tracing(test_device(), bvh.nodes, triangles, 100, true);
  TraceOptions options = options_for(GetParam());
  options.max_turns = 3;
  const TracedRays traced = tracing.on_device(rays, options);
  EXPECT_NE(describe_error_word(traced.error_word).find("trace_wide"), std::string::npos);
}

TEST_P(TraceWide, IsRefusedWithTestsThatDependOnTheOrder) {
  Layout layout;
  TreeSlots tree = plan_tree(layout, 1, 1);
  plan_wide(layout, tree);
  TraceOptions options = options_for(GetParam());
  options.triangle_test = TRIANGLE_FAST;
  const TracePlan trace = plan_trace(layout, tree, 1, options);
  GpuExecutor executor(test_device(), layout);
  Chain chain = executor.chain();
  EXPECT_THROW(append_trace(chain, tree, trace), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Rays, TraceWide, testing::Values(Walk::wide_single, Walk::wide_packets),
                         [](const auto& info) {
                           return std::string(info.param == Walk::wide_packets ? "InPackets"
                                                                               : "ByThemselves");
                         });

}  // namespace
}  // namespace coppice
