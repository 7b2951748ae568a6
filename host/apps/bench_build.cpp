#include "analysis/tree_hash.h"
#include "apps/bench.h"
#include "apps/frame.h"
#include "apps/measure_build.h"
#include "builders/registry.h"
#include "scene/scene_source.h"

namespace coppice {

namespace {

constexpr double limit_seconds = 120;

}  // namespace

BenchRow bench_row(std::string name, std::string input, std::uint64_t size, const SteadyTime& time) {
  return {std::move(name),
          std::move(input),
          size,
          spread_of(time.runs_ms),
          static_cast<std::uint32_t>(time.runs_ms.size()),
          time.warm_up_runs,
          time.stable};
}

std::vector<std::uint32_t> bench_sizes(std::uint32_t first, std::uint32_t most) {
  std::vector<std::uint32_t> sizes;
  for (std::uint64_t size = first; size < most; size *= 4) sizes.push_back(static_cast<std::uint32_t>(size));
  sizes.push_back(most);
  return sizes;
}

void bench_build(CheckedDevice& device, const Options& options, const AddRow& add) {
  for (const std::uint32_t count : bench_sizes(10000, options.most)) {
    const SceneArrays arrays = scene_arrays(open_scene("scatter:" + std::to_string(count)));
    const std::uint32_t bits = morton_bits_for(options, arrays.triangles);
    Layout layout(device.device.properties().max_block_bytes);
    const BuildPlan plan = plan_build(layout, count, device.build_options(options, bits));
    GpuExecutor executor(device.device, layout);
    executor.upload(plan.triangles, std::span<const Triangle>(arrays.triangles));
    Chain chain = executor.chain();
    append_build(chain, plan);
    Recorder recorder = executor.record(chain.steps());
    recorder.submit_and_wait(limit_seconds);
    check_state(executor, plan);
    const Bvh expected = find_cpu_builder("ploc").build(arrays.triangles, {options.radius, bits});
    if (tree_hash(read_tree(executor, plan)) != tree_hash(expected.nodes))
      throw DeviceError("build of " + std::to_string(count) + " triangles: not the tree of ploc");
    BenchRow row = bench_row("gpu-ploc", "scatter", count, measure_steady({.runs = options.runs}, [&] {
                               return recorder.submit_and_wait(limit_seconds).total_ms;
                             }));
    std::uint64_t bytes = 0;
    for (const std::uint64_t block : layout.block_bytes()) bytes += block;
    row.scratch_bytes = static_cast<double>(bytes - plan.triangles.bytes() - plan.nodes.bytes()) / count;
    add(row);
  }
}

}  // namespace coppice
