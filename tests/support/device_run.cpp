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

TracedRays trace_on_device(std::span<const Node> nodes, std::span<const Triangle> triangles,
                           std::span<const Ray> rays, const TraceOptions& options) {
  TraceOptions with_brute_force = options;
  if (nodes.empty()) with_brute_force.walk = Walk::brute_force;
  RayTracing tracing(test_device(), nodes, triangles, static_cast<std::uint32_t>(rays.size()));
  return tracing.on_device(rays, with_brute_force);
}

}  // namespace coppice
