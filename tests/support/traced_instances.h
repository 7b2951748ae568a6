#pragma once

#include <gtest/gtest.h>

#include "analysis/compare.h"
#include "analysis/judge_hits.h"
#include "builders/ploc.h"
#include "stages/lockstep_executor.h"
#include "support/device_run.h"
#include "support/instances.h"
#include "support/triangles.h"

namespace coppice {

struct TracedInstances {
  std::vector<Hit> hits;  // with triangles of the flattened scene
  std::vector<uint> hit_instances;
  std::vector<Aabb> boxes;
  std::vector<PlacedInstance> placed;
  BuildState state;
  std::uint32_t height;  // of both levels
};

// Two levels in lockstep.
class DeviceInstances : public DeviceTest {
 protected:
  static TracedInstances trace(const InstancesToTrace& scene, std::span<const Ray> rays,
                               const TraceOptions& options = test_trace_options(1, 1),
                               const BuildOptions& build = {}) {
    Layout layout(test_device().properties().max_block_bytes);
    const InstanceSlots slots = plan_for(layout, scene, rays.size(), build);
    LockstepExecutor executor(test_device(), layout);
    upload_instances(executor, slots, scene, rays);
    const auto difference = executor.run([&](Chain& chain) { append_all(chain, slots, options); });
    EXPECT_FALSE(difference) << difference->stage << ", " << difference->slot << "[" << difference->index
                             << "]\ncpu " << difference->cpu << "\ngpu " << difference->gpu;
    const GpuExecutor& gpu = executor.gpu();
    TracedInstances traced{gpu.read(slots.rays.hits),           gpu.read(slots.hit_instances),
                           gpu.read(slots.plan.instance_boxes), gpu.read(slots.plan.placed),
                           gpu.read(slots.plan.top.state)[0],   gpu.read(slots.plan.mesh_height)[0]};
    if (traced.state.active_count > 0)
      traced.height += gpu.read(Slot<Node>{slots.plan.top.nodes.place, 1})[0].height;
    traced.hits = flattened_hits(scene, traced.hits, traced.hit_instances);
    return traced;
  }

  // Judged by exact arithmetic (analysis/judge_hits.h).
  static void expect_no_miss(std::span<const Node> nodes, std::span<const Triangle> triangles,
                             std::span<const Ray> rays, std::span<const Hit> hits, const std::string& what) {
    const HitVerdicts verdicts = judge_hits(nodes, triangles, rays, hits);
    EXPECT_EQ(verdicts.false_hits, 0u) << what;
    EXPECT_EQ(verdicts.missed, 0u) << what;
  }

  // By brute force over the flattened scene, which no box can lose a hit of. Rays are not from far away.
  static void expect_flat(const InstancesToTrace& scene, std::span<const Ray> rays, const std::string& what) {
    const TracedInstances traced = trace(scene, rays);
    EXPECT_EQ(traced.state.error_word, 0u) << what;
    const std::vector<Triangle> triangles = flattened(scene);
    TraceOptions options = test_trace_options(1, 1);
    options.walk = Walk::brute_force;
    const TracedRays flat = trace_on_device({}, triangles, rays, options);
    const HitDifference difference = compare_hits(traced.hits, flat.hits);
    EXPECT_EQ(difference.count, 0u) << what << ": other triangles " << difference.other_triangle;
    expect_no_miss(build_ploc(triangles, {16, 30}).nodes, triangles, rays, traced.hits, what);
  }
};

// Meshes of all small sizes.
inline InstancesToTrace soups(std::uint32_t instances, float exponent, std::uint64_t seed) {
  InstancesToTrace scene;
  scene.meshes = {random_soup(200, 1), random_soup(1, 2), {}, random_soup(33, 3), random_soup(2, 4)};
  Random random(seed);
  for (uint i = 0; i < instances; ++i) {
    scene.mesh_index.push_back(i % 5);
    scene.transforms.push_back(random_transform(random, exponent, 3));
  }
  return scene;
}

}  // namespace coppice
