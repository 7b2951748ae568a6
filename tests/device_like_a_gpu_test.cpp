// What only GPUs run, run on CPU devices: copies through staging buffers, and kernels in whose subgroups the
// invocations wait for each other. Builders and tracers give what they give without. (On a GPU both devices
// are the same.)
#include <gtest/gtest.h>

#include "analysis/compare.h"
#include "analysis/tree_hash.h"
#include "pipeline/batch.h"
#include "pipeline/ray_tracing.h"
#include "pipeline/refit.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/device_run.h"
#include "support/masked_scene.h"
#include "support/rays.h"
#include "support/traced_instances.h"
#include "support/wide.h"

namespace coppice {
namespace {

class LikeAGpu : public DeviceTest {
 protected:
  void TearDown() override {
    DeviceTest::TearDown();
    for (const std::string& message : device().take_validation_messages()) ADD_FAILURE() << message;
  }

  static Device& device() {
    static Device device({"", true, true});
    return device;
  }

  static void expect_same_tree(std::span<const Triangle> triangles, const BuildOptions& options,
                               const std::string& what) {
    const auto hash_on = [&](Device& on) { return tree_hash(build_on(on, triangles, options).nodes); };
    EXPECT_EQ(hash_on(device()), hash_on(test_device())) << what;
  }
};

TEST_F(LikeAGpu, NeitherLanesInStepNorSharedMemory) {
  EXPECT_FALSE(device().properties().lanes_in_step);
  EXPECT_FALSE(device().properties().shared_memory);
}

TEST_F(LikeAGpu, SameTreesByEverySort) {
  const std::vector<Triangle> triangles = random_triangles(100000, 8);
  for (const std::uint32_t bits : {30u, 60u}) {
    for (const std::uint32_t sort :
         {SORT_SCAN, SORT_SCAN_8, SORT_SCAN_11, SORT_ONESWEEP_RUNS, SORT_ONESWEEP_MATCH}) {
      BuildOptions options;
      options.morton_bits = bits;
      options.variants.sort = sort;
      expect_same_tree(triangles, options,
                       to_string(options.variants) + ", " + std::to_string(bits) + " bits");
    }
  }
}

TEST_F(LikeAGpu, SameTreesByEveryBuilder) {
  for (const char* name : {"planar-grid", "coincident-and-random", "nested"}) {
    const auto triangles = scene_arrays(find_hard_case(name)->make(5000, 1)).triangles;
    for (const DeviceBuilder builder : {DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh}) {
      for (const bool lookback : {true, false}) {
        BuildOptions options;
        options.builder = builder;
        options.lookback = lookback;
        expect_same_tree(triangles, options,
                         name + (", builder " + std::to_string(static_cast<int>(builder))) +
                             (lookback ? "" : ", without lookback"));
      }
    }
  }
}

// Kernel by kernel beside the twins, of more than one tile of the sort.
TEST_F(LikeAGpu, SameRefits) {
  const std::vector<Triangle> triangles = random_triangles(20000, 6), moved = random_triangles(20000, 7);
  Layout layout(device().properties().max_block_bytes);
  BuildPlan plan = plan_build(layout, 20000, {});
  const WidePlan wide = plan_wide(layout, plan, &plan);
  const RefitPlan refit = plan_refit(layout, plan, &plan);
  LockstepExecutor executor(device(), layout);
  const auto expect_no_difference = [&](const auto& append) {
    const auto difference = executor.run(append);
    EXPECT_FALSE(difference) << difference->stage << ", " << difference->slot << "[" << difference->index
                             << "]";
  };
  executor.upload(plan.triangles, std::span<const Triangle>(triangles));
  expect_no_difference([&](Chain& chain) {
    append_build(chain, plan);
    append_wide(chain, plan, wide);
    append_refit_order(chain, plan, refit);
  });
  executor.upload(plan.triangles, std::span<const Triangle>(moved));
  expect_no_difference([&](Chain& chain) {
    append_refit(chain, plan, refit);
    append_wide_boxes(chain, plan, wide);
    append_tree_cost(chain, plan, refit);
  });
}

// Of several tiles of the sort, of which the last ones have no keys.
TEST_F(LikeAGpu, TheTreeOfAsManyTrianglesAsTheDeviceSays) {
  const std::vector<Triangle> triangles = random_triangles(60000, 9);
  constexpr uint count = 20001;
  for (const std::uint32_t sort : {SORT_SCAN, SORT_ONESWEEP_RUNS, SORT_ONESWEEP_MATCH}) {
    BuildOptions options;
    options.variants.sort = sort;
    Layout layout(device().properties().max_block_bytes);
    const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
    const auto count_slot = layout.add<uint>("count", 1);
    GpuExecutor executor(device(), layout);
    executor.upload(plan.triangles, std::span<const Triangle>(triangles));
    executor.upload(count_slot, std::span<const uint>(&count, 1));
    Chain chain = executor.chain();
    append_build(chain, plan, {.count_at = chain.at(count_slot)});
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    const BuiltTree alone = build_on(test_device(), std::span(triangles).first(count), options);
    const std::vector<Node> nodes = executor.read(Slot<Node>{plan.nodes.place, alone.nodes.size()});
    EXPECT_EQ(tree_hash(nodes), tree_hash(alone.nodes)) << to_string(options.variants);
  }
}

TEST_F(LikeAGpu, SameTreesOfABatch) {
  std::vector<Triangle> triangles;
  std::vector<BatchRange> ranges;
  for (const char* name : {"planar-grid", "coincident-and-random", "nested"}) {
    for (const std::uint32_t size : {1u, 7u, 64u, 250u}) {
      const auto more = scene_arrays(find_hard_case(name)->make(size, 1)).triangles;
      ranges.push_back({static_cast<uint>(triangles.size()), static_cast<uint>(more.size())});
      triangles.insert(triangles.end(), more.begin(), more.end());
    }
  }
  Layout layout(device().properties().max_block_bytes);
  const BatchPlan plan = plan_batch(layout, static_cast<std::uint32_t>(triangles.size()),
                                    static_cast<std::uint32_t>(ranges.size()), {});
  GpuExecutor executor(device(), layout);
  executor.upload(plan.primitives.triangles, std::span<const Triangle>(triangles));
  executor.upload(plan.ranges, std::span<const BatchRange>(ranges));
  Chain chain = executor.chain();
  append_batch(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  const std::vector<Node> nodes = executor.read(plan.nodes);
  for (const BatchRange& range : ranges) {
    const BuiltTree alone =
        build_on(test_device(), std::span(triangles).subspan(range.first, range.count), {});
    const auto tree = std::span(nodes).subspan(2 * std::size_t{range.first}, alone.nodes.size());
    EXPECT_EQ(tree_hash(tree), tree_hash(alone.nodes)) << range.count;
  }
}

TEST_F(LikeAGpu, SameHitsOfInstances) {
  const InstancesToTrace scene = soups(200, 2, 1);
  const std::vector<Triangle> triangles = flattened(scene);
  const std::vector<Ray> rays = rays_at_edges(triangles, 2000, 2);
  const auto traced_on = [&](Device& on) {
    Layout layout(on.properties().max_block_bytes);
    const InstanceSlots slots = plan_for(layout, scene, rays.size());
    GpuExecutor executor(on, layout);
    upload_instances(executor, slots, scene, rays);
    Chain chain = executor.chain();
    append_all(chain, slots, test_trace_options(1, 1));
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    return std::pair(executor.read(slots.rays.hits), executor.read(slots.hit_instances));
  };
  const auto here = traced_on(test_device()), there = traced_on(device());
  EXPECT_EQ(compare_hits(here.first, there.first).count, 0u);
  EXPECT_EQ(here.second, there.second);
}

TEST_F(LikeAGpu, WideNodesOfADeepTree) {
  const std::vector<Node> nodes =
      below_a_chain(build_on(test_device(), random_triangles(20000, 5, 0.01f), {}).nodes, 230);
  Layout layout(device().properties().max_block_bytes);
  const UploadedTree uploaded = plan_uploaded(layout, nodes);
  LockstepExecutor executor(device(), layout);
  upload_tree(executor, uploaded.tree, nodes);
  const auto difference =
      executor.run([&](Chain& chain) { append_wide(chain, uploaded.tree, uploaded.wide); });
  EXPECT_FALSE(difference) << difference->stage << ", " << difference->slot;
}

TEST_F(LikeAGpu, SameHitsThroughEveryTree) {
  const std::vector<Triangle> triangles = random_triangles(20000, 3, 0.2f);
  const std::vector<Node> nodes = build_on(test_device(), triangles, {}).nodes;
  std::vector<Ray> rays;
  for (const Triangle& t : random_triangles(5000, 4, 2.0f)) rays.push_back({t.a, 0, t.b - t.a, 1e9f});
  const auto count = static_cast<std::uint32_t>(rays.size());
  RayTracing here(test_device(), nodes, triangles, count, true),
      there(device(), nodes, triangles, count, true);
  TraceOptions options = test_trace_options(1, 1);
  const TracedRays expected = here.on_device(rays, options);
  EXPECT_GT(expected.hit_count, 1000u);
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    options.walk = walk;
    const TracedRays traced = there.on_device(rays, options);
    EXPECT_EQ(traced.error_word, 0u);
    EXPECT_EQ(compare_hits(traced.hits, expected.hits).count, 0u) << "walk " << static_cast<int>(walk);
    EXPECT_EQ(there.any_on_device(rays, options).any_hits, here.any_by_twins(rays, options).any_hits)
        << "walk " << static_cast<int>(walk);
  }
}

// Of triangles that let rays through, with shadows.
TEST_F(LikeAGpu, SamePicturesOfMasks) {
  Scene scene = masked_scene(300);
  scene.light.shadows = true;
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene));
  const auto picture_on = [&](Device& on, Walk walk) {
    FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(60, 40)};
    options.trace.walk = walk;
    Layout layout(on.properties().max_block_bytes);
    const FramePlan plan = plan_frame(layout, arrays, options);
    GpuExecutor executor(on, layout);
    upload_frame(executor, plan, arrays, make_film(scene, {}, 60, 40, 1));
    Chain chain = executor.chain();
    append_frame(chain, plan);
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    return executor.read(plan.trace.image);
  };
  const std::vector<uint> expected = picture_on(test_device(), Walk::binary);
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single})
    EXPECT_EQ(picture_on(device(), walk), expected) << name_of(walk);
}

}  // namespace
}  // namespace coppice
