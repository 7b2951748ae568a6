#include <algorithm>

#include "analysis/tree_hash.h"
#include "builders/registry.h"
#include "measure/bench.h"
#include "measure/measure_build.h"
#include "render/frame.h"
#include "render/scene_room.h"
#include "scene/scene_source.h"
#include "stages/stages.h"

namespace coppice {

namespace {

std::string scatter_of(std::uint32_t count) { return "scatter:" + std::to_string(count); }

void check_scatter_room(CheckedDevice& device, const BenchOptions& options) {
  check_room(scatter_of(options.most), {&device.device(), options.builder.least_build_options()},
             device.notes());
}

// A build of scattered triangles on the device, done once and found right.
class CheckedBuild {
 public:
  CheckedBuild(CheckedDevice& device, BuilderChoice choice, const NamedDeviceBuilder& builder,
               std::uint32_t count)
      : arrays_(scene_arrays(open_scene(scatter_of(count)))),
        layout_(device.properties().max_block_bytes),
        plan_(plan(device, choice, builder)),
        executor_(device.device(), layout_) {
    executor_.upload(plan_.triangles, std::span<const Triangle>(arrays_.triangles));
    Chain chain = executor_.chain();
    append_build(chain, plan_);
    steps_ = chain.steps();
    executor_.record(steps_).submit_and_wait(measured_limit_seconds);
    check_state(executor_, plan_);
    const Bvh expected = find_cpu_builder(builder.cpu_builder)
                             .build(arrays_.triangles, {choice.radius, plan_.options.morton_bits});
    if (tree_hash(read_tree(executor_, plan_)) != tree_hash(expected.nodes))
      throw DeviceError(std::string(builder.name) + " of " + std::to_string(count) +
                        " triangles: not the tree of " + std::string(builder.cpu_builder));
    arrays_ = {};
  }

  const std::vector<Step>& steps() const { return steps_; }
  GpuExecutor& executor() { return executor_; }
  RunCounts counts() const { return counts_of_build(executor_, plan_); }
  std::uint64_t device_bytes() const { return coppice::device_bytes(layout_); }
  // What it holds on the device beside triangles and nodes.
  std::uint64_t scratch_bytes() const {
    return device_bytes() - plan_.triangles.bytes() - plan_.nodes.bytes();
  }

 private:
  BuildPlan plan(CheckedDevice& device, BuilderChoice& choice, const NamedDeviceBuilder& builder) {
    choice.name = builder.name;
    return plan_build(layout_, arrays_.triangle_count(),
                      device.build_options(choice.build_options(arrays_.triangles)));
  }

  SceneArrays arrays_;
  Layout layout_;
  BuildPlan plan_;
  GpuExecutor executor_;
  std::vector<Step> steps_;
};

BenchRow bench_builder(CheckedDevice& device, const BenchOptions& options, const NamedDeviceBuilder& builder,
                       std::uint32_t count) {
  CheckedBuild build(device, options.builder, builder, count);
  Recorder recorder = build.executor().record(build.steps());
  const auto run = [&] { return recorder.submit_and_wait(measured_limit_seconds).total_ms; };
  BenchRow row = bench_row(std::string(builder.name), "scatter", count,
                           measure_steady(steady_options(options, run()), run));
  const KernelSplit split = split_time(build.executor(), build.steps(), measured_limit_seconds);
  const KernelSums sums(split, build.counts());
  row.kernels = kernel_table(sums, find_copy_limit(device, sums.largest_dispatch()), row.ms.median);
  const double scratch = static_cast<double>(build.scratch_bytes()) / count;
  row.figures = {{"scratch_bytes_per_triangle", scratch},
                 {"device_bytes_per_triangle", static_cast<double>(build.device_bytes()) / count}};
  if (!row.kernels.untimed) row.figures.emplace_back("timed_ms", row.kernels.sum().ms);
  row.note = format("%.1f bytes of scratch a triangle", scratch);
  return row;
}

// The chain with a mark before the first round, so that the rounds have a time of their own.
std::vector<Step> with_mark(std::vector<Step> steps) {
  const auto leaves =
      std::ranges::find(steps, static_cast<const StageDeclaration*>(&stages::ploc_leaves), stage_of);
  steps.insert(leaves, Mark{});
  return steps;
}

BenchRow bench_rounds(CheckedDevice& device, const BenchOptions& options, std::uint32_t count) {
  if (device.properties().timestamp_period_ns == 0)
    throw DeviceError("bench ploc: " + device.properties().name +
                      " has no timestamps, which tell the rounds from the rest of a build");
  CheckedBuild build(device, options.builder, *find_device_builder("gpu-ploc"), count);
  const std::vector<Step> needed = split_time(build.executor(), build.steps(), measured_limit_seconds).steps;
  Recorder whole = build.executor().record(with_mark(build.steps()));
  Recorder lean = build.executor().record(with_mark(needed));
  std::vector<double> whole_ms, empty_ms;
  const auto run = [&] {
    // In turns, and either first, so that both meet the same machine.
    const bool whole_first = whole_ms.size() % 2 == 0;
    const double before_ms = whole_first ? 0 : lean.submit_and_wait(measured_limit_seconds).total_ms;
    const Recorder::Times times = whole.submit_and_wait(measured_limit_seconds);
    const double lean_ms = whole_first ? lean.submit_and_wait(measured_limit_seconds).total_ms : before_ms;
    whole_ms.push_back(times.total_ms);
    empty_ms.push_back(times.total_ms - lean_ms);
    return times.total_ms - times.marks_ms.at(0);
  };
  const SteadyTime time = measure_steady(steady_options(options, run()), run);
  BenchRow row = bench_row("ploc", "scatter", count, time);
  for (std::vector<double>* const all : {&whole_ms, &empty_ms})
    all->erase(all->begin(), all->end() - row.runs);
  const double build_ms = spread_of(whole_ms).median;
  const double share = 100 * spread_of(empty_ms).median / build_ms;

  const RunCounts counts = build.counts();
  double clusters = 0;
  for (const PlocRound& round : counts.rounds) clusters += round.cluster_count;
  const double ns = row.ms.median * 1e6 / clusters;
  row.figures = {{"rounds", static_cast<double>(counts.rounds.size() - 1)},
                 {"clusters_in", clusters},
                 {"ns_per_cluster", ns},
                 {"empty_dispatches", static_cast<double>(build.steps().size() - needed.size())},
                 {"build_ms", build_ms},
                 {"empty_percent", share}};
  row.note = format("%zu rounds, %.2f ns a cluster, empty dispatches %.1f %% of the build",
                    counts.rounds.size() - 1, ns, share);
  return row;
}

}  // namespace

void bench_build(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  check_scatter_room(device, options);  // before the smaller sizes take their time
  for (const NamedDeviceBuilder& builder : device_builders()) {
    const std::string name(builder.name);
    const bool chosen = options.builders.empty() || std::ranges::count(options.builders, name);
    if (!chosen || !is_wanted(options, name, "scatter")) continue;
    for (const std::uint32_t count : bench_sizes(10000, options.most))
      add(bench_builder(device, options, builder, count));
  }
}

void bench_ploc(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  if (!is_wanted(options, "ploc", "scatter")) return;
  check_scatter_room(device, options);
  for (const std::uint32_t count : bench_sizes(5000, options.most)) add(bench_rounds(device, options, count));
}

}  // namespace coppice
