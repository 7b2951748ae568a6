#include "support/device_run.h"

#include <cstring>

#include "stages/gpu_executor.h"
#include "stages/stages.h"

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
  const auto node_slot = layout.add<Node>("nodes", nodes.size());
  const auto triangle_slot = layout.add<Triangle>("triangles", triangles.size());
  const auto ray_slot = layout.add<Ray>("rays", rays.size());
  const auto hit_slot = layout.add<Hit>("hits", rays.size());
  const auto counters = layout.add<TraceCounters>("counters", 1);
  const auto state_slot = layout.add<BuildState>("state", 1);

  GpuExecutor executor(test_device(), layout);
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
  BuildState state{};
  state.active_count = static_cast<uint>((nodes.size() + 1) / 2);
  executor.upload(node_slot, nodes);
  executor.upload(triangle_slot, triangles);
  executor.upload(ray_slot, rays);
  executor.upload(hit_slot, std::span<const Hit>(hits));
  executor.upload(state_slot, std::span<const BuildState>(&state, 1));

  Chain chain = executor.chain();
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  const uvec3 groups{(ray_count + TRACE_GROUP - 1) / TRACE_GROUP, 1, 1};
  if (!nodes.empty()) {
    chain.run(stages::trace_closest,
              {chain.at(node_slot), chain.at(triangle_slot), chain.at(ray_slot), chain.at(hit_slot),
               chain.at(counters), chain.at(state_slot), ray_count, options.stack_entries},
              groups, {options.max_turns, options.visits_per_turn, options.stack_entries});
  } else {
    const auto triangle_count = static_cast<std::uint32_t>(triangles.size());
    for (std::uint32_t first = 0; first < triangle_count; first += BRUTE_FORCE_SLICE) {
      chain.run(stages::trace_brute_force,
                {chain.at(triangle_slot), chain.at(ray_slot), chain.at(hit_slot), chain.at(counters),
                 ray_count, first, std::min(BRUTE_FORCE_SLICE, triangle_count - first), 0},
                groups);
    }
  }
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  return {executor.read(hit_slot), executor.read(state_slot)[0].error_word};
}

}  // namespace coppice
