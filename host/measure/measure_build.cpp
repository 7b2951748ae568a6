#include "measure/measure_build.h"

#include <chrono>
#include <optional>
#include <thread>

#include "analysis/tree_hash.h"
#include "builders/registry.h"
#include "measure/progress.h"
#include "measure/steady_state.h"
#include "measure/trace_events.h"
#include "stages/errors.h"

namespace coppice {

void check_state(const GpuExecutor& executor, const TreeSlots& tree) {
  const std::string error = describe_error_word(executor.read(tree.state)[0].error_word);
  if (!error.empty()) throw DeviceError(error);
}

std::vector<Node> read_tree(const GpuExecutor& executor, const TreeSlots& tree) {
  const std::uint64_t active = executor.read(tree.state)[0].active_count;
  return executor.read(Slot<Node>{tree.nodes.place, active == 0 ? 0 : 2 * active - 1});
}

std::vector<WideNode> read_wide_tree(const GpuExecutor& executor, const TreeSlots& tree) {
  const WideCounts counts = executor.read(tree.wide_counts)[0];
  return executor.read(Slot<WideNode>{tree.wide_nodes.place, counts.node_count});
}

BuildReport report_for(const BuilderChoice& builder, const Scene& scene, std::span<const Triangle> triangles,
                       const Note& note) {
  BuildReport report;
  report.scene = scene.name;
  report.triangles = scene.indices.size();
  report.inactive = count_inactive(scene);
  report.instances = scene.instances.size();
  report.offset = scene.offset;
  report.builder = builder.name;
  report.radius = builder.radius;
  report.leaf_size = builder.leaf_size;
  report.morton_bits = builder.bits_for(triangles);
  const bool sorts = builder.on_device() || find_cpu_builder(builder.name).uses_morton_codes;
  if (note && sorts && builder.morton_bits == 0 && report.morton_bits == 60)
    note("Morton codes of 60 bits, as cells of 30 are crowded (--morton-bits)");
  return report;
}

void describe_tree(BuildReport& report, std::span<const Node> nodes) {
  report.quality = measure_quality(nodes);
  report.tree_hash = tree_hash(nodes);
}

RunCounts counts_of_build(const GpuExecutor& executor, const BuildPlan& plan, const WidePlan* wide) {
  const BuildState state = executor.read(plan.state)[0];
  RunCounts counts;
  counts.active_count = state.active_count;
  if (plan.rounds.count > 0)  // only PLOC has rounds
    counts.rounds = executor.read(Slot<PlocRound>{plan.rounds.place, state.round_count + 1});
  if (wide) count_wide(executor, plan, *wide, counts);
  return counts;
}

void count_wide(const GpuExecutor& executor, const TreeSlots& tree, const WidePlan& wide, RunCounts& counts) {
  counts.wide_nodes = executor.read(tree.wide_counts)[0].node_count;
  counts.wide_levels = executor.read(wide.levels);
}

namespace {

// Converts the tree of the last submit `runs` times after a warm-up.
void measure_wide(GpuExecutor& executor, const TreeSlots& tree, const WidePlan& wide, BuildReport& report,
                  std::uint32_t runs) {
  Chain chain = executor.chain();
  append_wide(chain, tree, wide);
  Recorder recorder = executor.record(chain.steps());
  recorder.submit_and_wait(measured_limit_seconds);  // compiles the kernels
  std::vector<double> wide_ms;
  for (std::uint32_t run = 0; run < runs; ++run)
    wide_ms.push_back(recorder.submit_and_wait(measured_limit_seconds).total_ms);
  check_state(executor, tree);
  report.wide_ms = spread_of(wide_ms);
  report.wide = measure_wide_quality(read_wide_tree(executor, tree));
}

}  // namespace

namespace {

// The build of the last tree once more, and its conversion, with a timestamp after each dispatch.
void split_build(CheckedDevice& device, GpuExecutor& executor, const BuildPlan& plan, const WidePlan* wide,
                 const BuildRuns& runs, BuildReport& report) {
  Chain chain = executor.chain();
  append_build(chain, plan);
  if (wide) append_wide(chain, plan, *wide);
  const KernelSplit split = split_time(executor, chain.steps(), measured_limit_seconds);
  TraceEvents events;
  events.add(split);
  events.write(runs.trace_events, device);
  check_state(executor, plan);
  const RunCounts counts = counts_of_build(executor, plan, wide);
  const KernelSums sums(split, counts);
  const auto limit = find_copy_limit(device, sums.largest_dispatch());
  report.kernels = kernel_table(sums, limit, report.build_ms.median + report.wide_ms.median);
  if (runs.rounds) report.ploc_rounds = ploc_round_times(split, counts);
}

}  // namespace

std::uint64_t device_bytes(const Layout& layout) {
  std::uint64_t bytes = 0;
  for (const std::uint64_t block : layout.block_bytes()) bytes += block;
  return bytes;
}

void describe_device_build(const CheckedDevice& device, const GpuExecutor& executor, const BuildPlan& plan,
                           BuildReport& report) {
  report.device = device.properties().name;
  report.driver = device.properties().driver;
  report.variants = to_string(plan.options.variants);
  report.lookback = plan.options.lookback;
  report.rounds = executor.read(plan.state)[0].round_count;
  report.rounds_bound = plan.rounds_bound;
  describe_tree(report, read_tree(executor, plan));
}

BuildReport measure_device_build(CheckedDevice& device, std::span<const Triangle> triangles,
                                 const BuildOptions& options, const BuildRuns& runs, BuildReport report,
                                 Bvh* bvh) {
  Layout layout(device.properties().max_block_bytes);
  BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
  std::optional<WidePlan> wide;
  if (runs.wide) wide = plan_wide(layout, plan, &plan, device.properties().max_turns());
  GpuExecutor executor(device.device(), layout);
  executor.upload(plan.triangles, triangles);
  report.device_bytes = device_bytes(layout);
  Chain chain = executor.chain();
  append_build(chain, plan);
  Recorder recorder = executor.record(chain.steps());
  Progress progress("building", runs.runs + 2);
  recorder.submit_and_wait(measured_limit_seconds);  // compiles the kernels
  progress.step();
  report.tree_hash = tree_hash(read_tree(executor, plan));
  std::vector<double> build_ms, wall_ms;
  for (std::uint32_t run = 0; run < runs.runs; ++run) {
    const Recorder::Times times = recorder.submit_and_wait(measured_limit_seconds);
    build_ms.push_back(times.total_ms);
    wall_ms.push_back(times.wall_ms);
    if (tree_hash(read_tree(executor, plan)) != report.tree_hash)
      throw DeviceError("run " + std::to_string(run + 1) + " built another tree than the warm-up");
    progress.step();
  }
  report.build_ms = spread_of(build_ms);
  report.wall_ms = spread_of(wall_ms);
  report.runs = runs.runs;
  if (wide) measure_wide(executor, plan, *wide, report, runs.runs);
  split_build(device, executor, plan, wide ? &*wide : nullptr, runs, report);
  describe_device_build(device, executor, plan, report);
  if (bvh) *bvh = {read_tree(executor, plan), executor.read(plan.state)[0].active_count, report.rounds};
  return report;
}

BuildReport measure_cpu_build(std::span<const Triangle> triangles, BuildReport report, std::uint32_t runs,
                              Bvh& bvh) {
  const CpuBuilder& builder = find_cpu_builder(report.builder);
  report.device = "host CPU, " + std::to_string(std::max(1u, std::thread::hardware_concurrency())) + " cores";
  std::vector<double> build_ms;
  Progress progress("building", runs);
  for (std::uint32_t run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    bvh = builder.build(triangles, {report.radius, report.morton_bits, report.leaf_size});
    build_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    progress.step();
  }
  report.build_ms = report.wall_ms = spread_of(build_ms);
  report.runs = runs;
  report.rounds = bvh.rounds;
  report.reference_cap_reached = bvh.reference_cap_reached;
  if (bvh.rounds > 0)
    report.rounds_bound = ploc_rounds_bound(static_cast<std::uint32_t>(triangles.size()), 1);
  describe_tree(report, bvh.nodes);
  return report;
}

}  // namespace coppice
