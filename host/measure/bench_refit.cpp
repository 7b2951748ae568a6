#include <algorithm>
#include <cmath>

#include "analysis/validate.h"
#include "analysis/wide_tree.h"
#include "measure/bench.h"
#include "measure/measure_build.h"
#include "pipeline/refit.h"
#include "render/scene_arrays.h"
#include "render/scene_room.h"

namespace coppice {

namespace {

// A wave goes through the scene, so that all boxes change.
void bend(std::vector<Triangle>& triangles) {
  const auto bent = [](vec3 p) { return vec3(p.x, p.y + 0.05f * std::sin(3 * p.x + 2 * p.z), p.z); };
  for (Triangle& t : triangles) t = {bent(t.a), bent(t.b), bent(t.c)};
}

// A tree that a device builds and refits, done once and found right.
class CheckedRefit {
 public:
  CheckedRefit(CheckedDevice& device, const BenchOptions& options, const std::string& scene,
               const NamedDeviceBuilder& builder)
      : device_(device), layout_(device.properties().max_block_bytes) {
    check_room(scene, {&device.device(), options.builder.least_build_options()}, device.notes());
    std::vector<Triangle> triangles = scene_arrays(open_scene(scene, options.up)).triangles;
    BuilderChoice choice = options.builder;
    choice.name = builder.name;
    plan_ = plan_build(layout_, static_cast<std::uint32_t>(triangles.size()),
                       device.build_options(choice.build_options(triangles)));
    const std::uint32_t max_turns = device.properties().max_turns();
    wide_ = plan_wide(layout_, plan_, &plan_, max_turns);
    refit_ = plan_refit(layout_, plan_, &plan_, max_turns);
    executor_.emplace(device.device(), layout_);
    executor_->upload(plan_.triangles, std::span<const Triangle>(triangles));
    run_once(build());
    run_once(widen());
    run_once(order());
    bend(triangles);
    executor_->upload(plan_.triangles, std::span<const Triangle>(triangles));
    run_once(refit());
    run_once(wide_boxes());
    check_state(*executor_, plan_);
    const std::vector<Node> nodes = read_tree(*executor_, plan_);
    const auto fault = find_fault(nodes, triangles, {.refitted = true});
    const auto wide_fault = find_wide_fault(read_wide_tree(*executor_, plan_), nodes, true);
    if (fault || wide_fault)
      throw DeviceError(std::string(builder.name) + " of " + scene +
                        ", refitted: " + (fault ? *fault : *wide_fault));
  }

  using Steps = std::vector<Step>;
  Steps build() {
    return steps([&](Chain& chain) { append_build(chain, plan_); });
  }
  Steps widen() {
    return steps([&](Chain& chain) { append_wide(chain, plan_, wide_); });
  }
  Steps order() {
    return steps([&](Chain& chain) { append_refit_order(chain, plan_, refit_); });
  }
  Steps refit() {
    return steps([&](Chain& chain) { append_refit(chain, plan_, refit_); });
  }
  Steps wide_boxes() {
    return steps([&](Chain& chain) { append_wide_boxes(chain, plan_, wide_); });
  }
  Steps cost() {
    return steps([&](Chain& chain) { append_tree_cost(chain, plan_, refit_); });
  }

  // The median of a few runs.
  double ms_of(const Steps& steps, std::uint32_t runs) {
    Recorder recorder = executor_->record(steps);
    recorder.submit_and_wait(measured_limit_seconds);
    std::vector<double> ms;
    for (std::uint32_t run = 0; run < runs; ++run)
      ms.push_back(recorder.submit_and_wait(measured_limit_seconds).total_ms);
    return median_of(std::move(ms));
  }

  BenchRow row(const BenchOptions& options, const std::string& name, const std::string& scene,
               const Steps& steps) {
    Recorder recorder = executor_->record(steps);
    const auto run = [&] { return recorder.submit_and_wait(measured_limit_seconds).total_ms; };
    BenchRow row =
        bench_row(name, scene, plan_.triangle_count, measure_steady(steady_options(options, run()), run));
    const KernelSplit split = split_time(*executor_, steps, measured_limit_seconds);
    const KernelSums sums(split, counts());
    std::uint64_t bytes = 0;
    for (const KernelSums::Sum& sum : sums.sums()) bytes += sum.bytes * sum.dispatches;
    const auto limit = find_copy_limit(device_, bytes);
    row.kernels = kernel_table(sums, limit, row.ms.median);
    row.figures = {{"bytes", static_cast<double>(bytes)}};
    if (limit) row.figures.emplace_back("copy_ms", limit->ms(bytes));
    return row;
  }

 private:
  void run_once(const Steps& steps) { executor_->record(steps).submit_and_wait(measured_limit_seconds); }

  Steps steps(const auto& append) {
    Chain chain = executor_->chain();
    append(chain);
    return chain.steps();
  }

  RunCounts counts() const {
    RunCounts counts = counts_of_build(*executor_, plan_, &wide_);
    counts.refit_levels = executor_->read(refit_.levels);
    return counts;
  }

  CheckedDevice& device_;
  Layout layout_;
  BuildPlan plan_;
  WidePlan wide_;
  RefitPlan refit_;
  std::optional<GpuExecutor> executor_;
};

void note_ratios(BenchRow& row, double build_ms) {
  const auto copy = std::ranges::find(row.figures, "copy_ms", &std::pair<std::string, double>::first);
  row.figures.emplace_back("build_ms", build_ms);
  row.figures.emplace_back("times_faster", build_ms / row.ms.median);
  row.note = format("build %.3f ms, %.1f times", build_ms, build_ms / row.ms.median);
  if (copy == row.figures.end()) return;
  const double of_copy = row.ms.median / copy->second;
  row.figures.emplace_back("times_copy", of_copy);
  row.note += format("; copy %.3f ms, %.1f times", copy->second, of_copy);
}

void bench_scene(CheckedDevice& device, const BenchOptions& options, const std::string& scene,
                 const NamedDeviceBuilder& builder, const AddRow& add) {
  const std::string name(builder.name.substr(builder.name.find('-') + 1));
  const bool binary = is_wanted(options, "refit-" + name, scene);
  const bool wide = is_wanted(options, "refit-wide-" + name, scene);
  if (!binary && !wide) return;
  CheckedRefit refit(device, options, scene, builder);
  const double build_ms = refit.ms_of(refit.build(), options.runs);
  const double wide_ms = refit.ms_of(refit.widen(), options.runs);
  // The build has brought its scratch back to where the order lay.
  const double order_ms = refit.ms_of(refit.order(), options.runs);
  if (binary) {
    BenchRow row = refit.row(options, "refit-" + name, scene, refit.refit());
    note_ratios(row, build_ms);
    row.figures.emplace_back("order_ms", order_ms);
    row.figures.emplace_back("cost_ms", refit.ms_of(refit.cost(), options.runs));
    row.note += format("; order %.3f ms", order_ms);
    add(std::move(row));
  }
  if (!wide) return;
  std::vector<Step> steps = refit.refit();
  for (const Step& step : refit.wide_boxes()) steps.push_back(step);
  BenchRow row = refit.row(options, "refit-wide-" + name, scene, steps);
  note_ratios(row, build_ms + wide_ms);
  add(std::move(row));
}

}  // namespace

void bench_refit(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty()) {
    for (const std::uint32_t count : bench_sizes(10000, options.most))
      scenes.push_back("scatter:" + std::to_string(count));
  }
  for (const std::string& scene : scenes) {
    for (const NamedDeviceBuilder& builder : device_builders()) {
      if (options.builders.empty() || std::ranges::count(options.builders, builder.name))
        bench_scene(device, options, scene, builder, add);
    }
  }
}

}  // namespace coppice
