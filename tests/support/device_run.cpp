#include "support/device_run.h"

#include <cstring>

#include "stages/gpu_executor.h"

namespace coppice {

BuiltTree build_on(Device& device, std::span<const Triangle> triangles, const BuildOptions& options,
                   int runs) {
  Layout layout(device.properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
  GpuExecutor executor(device, layout);
  executor.upload(plan.triangles, triangles);
  Chain chain = executor.chain();
  append_build(chain, plan);
  Recorder recorder = executor.record(chain.steps());

  BuiltTree tree{{}, {}, plan.rounds_bound};
  for (int run = 0; run < runs; ++run) {
    recorder.submit_and_wait(submit_limit_seconds);
    tree.state = executor.read(plan.state)[0];
    EXPECT_EQ(tree.state.error_word, 0u);
    const std::uint64_t active = tree.state.active_count;
    const auto nodes = executor.read(Slot<Node>{plan.nodes.place, active == 0 ? 0 : 2 * active - 1});
    if (run > 0) {
      EXPECT_EQ(std::memcmp(nodes.data(), tree.nodes.data(), nodes.size() * sizeof(Node)), 0)
          << "run " << run;
    }
    tree.nodes = nodes;
  }
  return tree;
}

Traced trace_on_device(std::span<const Node> nodes, std::span<const Triangle> triangles,
                       std::span<const Ray> rays, const TraceOptions& options) {
  Layout layout(test_device().properties().max_block_bytes);
  const TreeSlots tree = plan_tree(layout, static_cast<std::uint32_t>(triangles.size()), nodes.size());
  RaySlots slots;
  slots.rays = layout.add<Ray>("rays", rays.size());
  slots.hits = layout.add<Hit>("hits", rays.size());
  slots.counters = layout.add<TraceCounters>("counters", 1);

  GpuExecutor executor(test_device(), layout);
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
  BuildState state{};
  state.active_count = static_cast<uint>((nodes.size() + 1) / 2);
  executor.upload(tree.nodes, nodes);
  executor.upload(tree.triangles, triangles);
  executor.upload(slots.rays, rays);
  executor.upload(slots.hits, std::span<const Hit>(hits));
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));

  Chain chain = executor.chain();
  TraceOptions with_brute_force = options;
  with_brute_force.brute_force = nodes.empty();
  append_closest_hits(chain, tree, slots, static_cast<std::uint32_t>(rays.size()), with_brute_force);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  return {executor.read(slots.hits), executor.read(tree.state)[0].error_word};
}

}  // namespace coppice
