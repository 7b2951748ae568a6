#include <algorithm>
#include <vector>

#include "analysis/compare.h"
#include "analysis/tree_hash.h"
#include "builders/registry.h"
#include "measure/bench.h"
#include "measure/measure_build.h"
#include "measure/measure_frame.h"
#include "pipeline/bounded_submits.h"
#include "pipeline/instances.h"
#include "pipeline/trace_pieces.h"
#include "render/film.h"
#include "render/scene_arrays.h"
#include "scene/instances.h"
#include "stages/cpu_executor.h"
#include "stages/errors.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr std::size_t checked_instance_rays = 5000;

std::vector<std::uint32_t> swarm_sizes(std::uint32_t most) {
  std::vector<std::uint32_t> sizes;
  for (std::uint64_t size = 1000; size <= most; size *= 10) sizes.push_back(static_cast<std::uint32_t>(size));
  return sizes.empty() ? std::vector{most} : sizes;
}

// Instances of a few meshes on the device, and rays at them: all built and traced once and found right.
class SwarmBench {
 public:
  SwarmBench(CheckedDevice& device, const BenchOptions& options, const NamedDeviceBuilder& builder,
             std::uint32_t instance_count)
      : device_(device),
        options_(options),
        builder_(builder),
        count_(instance_count),
        scene_(make_instances(instance_count)),
        rays_(rays_through(make_film(scene_, options.camera, options.trace.width, options.trace.height, 1))),
        layout_(device.properties().max_block_bytes),
        plan_(planned()),
        executor_(device.device(), layout_) {
    upload();
    submit([&](Chain& chain) { append_all_meshes(chain, plan_); });
    submit([&](Chain& chain) {
      append_move(chain);
      append_top(chain, plan_);
    });
    check_top();
    check_hits();
  }

  BenchRow moves() {
    return measured("instances_move", [&](Chain& chain) { append_move(chain); });
  }

  BenchRow top() {
    return measured("instances_top", [&](Chain& chain) { append_top(chain, plan_); });
  }

  BenchRow trace() {
    Pace pace(submit_target_ms(device_.properties()), first_work(trace_options()));
    const auto run = [&] {
      double ms = 0;
      executor_.upload(slots_.hits, std::span<const Hit>(misses_));
      submit_pieces(executor_, pieces(static_cast<std::uint32_t>(rays_.size())), pace, Timestamps::total,
                    [&](const SubmittedPiece& piece) { ms += piece.times.total_ms; });
      check_state(executor_, plan_.top);
      return ms;
    };
    BenchRow row = bench_row("instances_trace", input(), rays_.size(),
                             measure_steady(steady_options(options_, run()), run));
    row.figures = {{"instances", static_cast<double>(count_)}};
    row.note = std::to_string(count_) + " instances";
    return row;
  }

  std::string input() const { return "swarm " + std::string(builder_.name); }

 private:
  InstancePlan planned() {
    std::vector<std::uint32_t> counts;
    for (const InstancedMesh& mesh : scene_.meshes) counts.push_back(mesh.triangle_count);
    BuilderChoice choice = options_.builder;
    choice.name = builder_.name;
    InstancePlan plan =
        plan_instances(layout_, counts, count_, device_.build_options(choice.least_build_options()));
    slots_ = {layout_.add<Ray>("rays", rays_.size()),
              layout_.add<Hit>("hits", rays_.size()),
              layout_.add<TraceCounters>("counters", 1),
              {}};
    swarm_ = {layout_.add<InstanceTransform>("rest", count_, Memory::source),
              layout_.add<uint>("turn", 1, Memory::source)};
    hit_instances_ = layout_.add<uint>("hit_instances", rays_.size());
    return plan;
  }

  void upload() {
    const SceneArrays arrays = scene_arrays(scene_);
    for (std::uint32_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
      const InstancedMesh& part = scene_.meshes[mesh];
      executor_.upload(
          triangles_of(plan_, mesh),
          std::span<const Triangle>(arrays.triangles).subspan(part.first_triangle, part.triangle_count));
    }
    constexpr uint turn = 1u << 24;
    for (const Ray& ray : rays_) misses_.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
    executor_.upload(plan_.meshes, std::span<const MeshRange>(plan_.ranges));
    executor_.upload(plan_.mesh_index, std::span<const uint>(arrays.mesh_index));
    executor_.upload(swarm_.rest, std::span<const InstanceTransform>(arrays.transforms));
    executor_.upload(swarm_.turn, std::span<const uint>(&turn, 1));
    executor_.upload(slots_.rays, std::span<const Ray>(rays_));
    executor_.upload(slots_.hits, std::span<const Hit>(misses_));
  }

  void append_move(Chain& chain) { append_moves(chain, plan_, swarm_, scene_.swarm->seed); }

  template <class Append>
  std::vector<Step> steps(const Append& append) {
    Chain chain = executor_.chain();
    append(chain);
    return chain.steps();
  }

  template <class Append>
  void submit(const Append& append) {
    executor_.record(steps(append)).submit_and_wait(measured_limit_seconds);
  }

  // Against the builder of the host, over the boxes that the device found.
  void check_top() {
    check_state(executor_, plan_.top);
    std::vector<Triangle> corners;
    for (const Aabb& box : executor_.read(plan_.instance_boxes))
      corners.push_back({box.box_min, box.box_max, box.box_max});
    const Bvh expected = find_cpu_builder(builder_.cpu_builder)
                             .build(corners, {plan_.options.radius, plan_.options.morton_bits});
    if (tree_hash(read_tree(executor_, plan_.top)) != tree_hash(expected.nodes))
      throw DeviceError("instances: not the tree of " + std::string(builder_.cpu_builder));
  }

  // Some rays, against the twin on what the device built.
  void check_hits() {
    const std::size_t stride = std::max<std::size_t>(rays_.size() / checked_instance_rays, 1);
    std::vector<Ray> some;
    for (std::size_t i = 0; i < rays_.size(); i += stride) some.push_back(rays_[i]);
    const auto count = static_cast<std::uint32_t>(some.size());
    executor_.upload(slots_.rays, std::span<const Ray>(some));
    submit([&](Chain& chain) {
      append_instance_hits(chain, plan_, slots_, hit_instances_, count, trace_options());
    });
    CpuExecutor cpu(layout_);
    const auto take = [&](const auto& slot) {
      using Value = typename decltype(executor_.read(slot))::value_type;
      cpu.upload(slot, std::span<const Value>(executor_.read(slot)));
    };
    take(plan_.meshes), take(plan_.mesh_triangles), take(plan_.mesh_nodes), take(plan_.transforms);
    take(plan_.placed), take(plan_.mesh_height), take(plan_.top.nodes), take(plan_.top.state),
        take(slots_.rays);
    cpu.upload(slots_.hits, std::span<const Hit>(misses_));
    Chain chain = cpu.chain();
    append_instance_hits(chain, plan_, slots_, hit_instances_, count, trace_options());
    cpu.run(chain.steps());
    const Slot<Hit> hits{slots_.hits.place, count};
    const HitDifference difference = compare_hits(cpu.read(hits), executor_.read(hits));
    const bool exact = device_.properties().type == DeviceType::cpu;
    if (exact ? difference.count > 0 : difference.other_triangle > count / 1000)
      throw DeviceError("instances: " + std::to_string(difference.count) + " of " + std::to_string(count) +
                        " hits are not the twin's");
    executor_.upload(slots_.rays, std::span<const Ray>(rays_));
  }

  TraceOptions trace_options() const { return device_.trace_options(options_.trace); }

  InstanceHitPieces pieces(std::uint32_t ray_count) const {
    return {plan_, slots_, hit_instances_, ray_count, trace_options()};
  }

  template <class Append>
  BenchRow measured(const std::string& name, const Append& append) {
    const std::vector<Step> all = steps(append);
    Recorder recorder = executor_.record(all);
    const auto run = [&] { return recorder.submit_and_wait(measured_limit_seconds).total_ms; };
    BenchRow row = bench_row(name, input(), count_, measure_steady(steady_options(options_, run()), run));
    const KernelSplit split = split_time(executor_, all, measured_limit_seconds);
    const KernelSums sums(split, counts_of_build(executor_, plan_.top));
    row.kernels = kernel_table(sums, find_copy_limit(device_, sums.largest_dispatch()), row.ms.median);
    if (!row.kernels.untimed) row.figures.emplace_back("timed_ms", row.kernels.sum().ms);
    return row;
  }

  CheckedDevice& device_;
  const BenchOptions& options_;
  const NamedDeviceBuilder& builder_;
  std::uint32_t count_;
  Scene scene_;
  std::vector<Ray> rays_;
  std::vector<Hit> misses_;
  RaySlots slots_;
  Slot<uint> hit_instances_;
  SwarmSlots swarm_;
  Layout layout_;
  InstancePlan plan_;
  GpuExecutor executor_;
};

}  // namespace

void bench_instances(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  for (const NamedDeviceBuilder& builder : device_builders()) {
    const std::string name(builder.name), input = "swarm " + name;
    if (!options.builders.empty() && !std::ranges::count(options.builders, name)) continue;
    const bool moves = is_wanted(options, "instances_move", input);
    const bool top = is_wanted(options, "instances_top", input);
    const bool trace = is_wanted(options, "instances_trace", input);
    if (!moves && !top && !trace) continue;
    for (const std::uint32_t count : swarm_sizes(options.most)) {
      SwarmBench bench(device, options, builder, count);
      if (moves) add(bench.moves());
      if (top) add(bench.top());
      if (trace) add(bench.trace());
    }
  }
}

}  // namespace coppice
