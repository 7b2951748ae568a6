#include "pipeline/self_check.h"

#include <cstring>

#include "pipeline/build.h"
#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"

namespace coppice {

namespace {

// Several tiles of every stage, and little work.
constexpr std::uint32_t check_triangles = 26000;
constexpr double limit_seconds = 60;

std::vector<Triangle> scattered_triangles() {
  std::uint32_t state = 1;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f;
  };
  std::vector<Triangle> triangles(check_triangles);
  for (Triangle& t : triangles) {
    t.a = {next(), next(), next()};
    t.b = t.a + vec3(next(), next(), next()) * 0.01f;
    t.c = t.a + vec3(next(), next(), next()) * 0.01f;
  }
  return triangles;
}

bool builds_right(Device& device, const Variants& variants, bool lookback,
                  const std::function<void(std::vector<Step>&)>& fault) {
  BuildOptions options;
  options.lookback = lookback;
  options.variants = variants;
  Layout layout(device.properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, check_triangles, options);
  const std::vector<Triangle> triangles = scattered_triangles();

  GpuExecutor gpu(device, layout);
  gpu.upload(plan.triangles, std::span<const Triangle>(triangles));
  Chain gpu_chain = gpu.chain();
  append_build(gpu_chain, plan);
  if (fault) fault(gpu_chain.steps());
  gpu.record(gpu_chain.steps()).submit_and_wait(limit_seconds);

  CpuExecutor cpu(layout);
  cpu.upload(plan.triangles, std::span<const Triangle>(triangles));
  Chain cpu_chain = cpu.chain();
  append_build(cpu_chain, plan);
  cpu.run(cpu_chain.steps());

  const std::vector<Node> gpu_nodes = gpu.read(plan.nodes), cpu_nodes = cpu.read(plan.nodes);
  return gpu.read(plan.state)[0].error_word == 0 &&
         std::memcmp(gpu_nodes.data(), cpu_nodes.data(), plan.nodes.bytes()) == 0;
}

}  // namespace

bool check_lookback(Device& device, const Variants& variants,
                    const std::function<void(std::vector<Step>&)>& fault) {
  if (builds_right(device, variants, true, fault)) return true;
  if (builds_right(device, variants, false, fault)) return false;
  throw DeviceError("device '" + device.properties().name + "' (" + device.properties().driver +
                    ") computes a wrong tree in the self-check; it is not used");
}

}  // namespace coppice
