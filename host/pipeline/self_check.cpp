#include "pipeline/self_check.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "pipeline/wide_plan.h"
#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"
#include "stages/nearly.h"

namespace coppice {

namespace {

// Several tiles of every stage, and little work.
constexpr std::uint32_t check_triangles = 26000;
// A small picture, packets of which go the same way, and others that do not.
constexpr std::uint32_t picture_edge = 16, other_rays = 64;
constexpr std::uint32_t brute_force_rays = 64;
constexpr double check_limit_seconds = 60;

class Random {
 public:
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_ >> 8) / 16777216.0f;
  }
  vec3 next_vec3() {
    const float x = next(), y = next();
    return {x, y, next()};
  }

 private:
  std::uint32_t state_ = 1;
};

std::vector<Triangle> scattered_triangles() {
  Random random;
  std::vector<Triangle> triangles(check_triangles);
  for (Triangle& t : triangles) {
    t.a = random.next_vec3();
    t.b = t.a + random.next_vec3() * 0.01f;
    t.c = t.a + random.next_vec3() * 0.01f;
  }
  return triangles;
}

std::vector<Ray> check_rays() {
  constexpr float far = std::numeric_limits<float>::infinity();
  Random random;
  std::vector<Ray> rays;
  for (std::uint32_t y = 0; y < picture_edge; ++y) {
    for (std::uint32_t x = 0; x < picture_edge; ++x) {
      const vec3 through = {static_cast<float>(x) / picture_edge, static_cast<float>(y) / picture_edge, 0};
      rays.push_back({{0.5f, 0.5f, -1}, 0, through - vec3(0.5f, 0.5f, -1), far});
    }
  }
  for (std::uint32_t i = 0; i < other_rays; ++i) {
    const vec3 origin = random.next_vec3();
    rays.push_back({origin, 0, random.next_vec3() - vec3(0.5f), far});
  }
  return rays;
}

// The chain of a use, and where it keeps what.
struct CheckPlan {
  CheckPlan(Device& device, const DeviceUse& use, bool lookback)
      : use(use), layout(device.properties().max_block_bytes) {
    BuildOptions options = use.build;
    options.lookback = lookback;
    build = plan_build(layout, check_triangles, options);
    if (std::ranges::any_of(use.traces, is_wide, &TraceOptions::walk))
      wide = plan_wide(layout, build, &build);
    for (std::size_t i = 0; i < use.traces.size(); ++i) {
      traces.push_back({layout.add<Ray>("rays", rays.size()), layout.add<Hit>("hits", rays.size()),
                        layout.add<TraceCounters>("counters", 1)});
    }
  }

  std::uint32_t ray_count(const TraceOptions& options) const {
    return options.walk == Walk::brute_force ? brute_force_rays : static_cast<std::uint32_t>(rays.size());
  }

  template <class Executor>
  void upload(Executor& executor) const {
    std::vector<Hit> misses;
    for (const Ray& ray : rays) misses.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
    executor.upload(build.triangles, std::span<const Triangle>(triangles));
    for (const RaySlots& slots : traces) {
      executor.upload(slots.rays, std::span<const Ray>(rays));
      executor.upload(slots.hits, std::span<const Hit>(misses));
    }
  }

  Chain append(Chain chain, bool with_build) const {
    if (with_build) append_build(chain, build);
    if (wide) append_wide(chain, build, *wide);
    for (std::size_t i = 0; i < traces.size(); ++i)
      append_closest_hits(chain, build, traces[i], ray_count(use.traces[i]), use.traces[i]);
    return chain;
  }

  const DeviceUse& use;
  const std::vector<Triangle> triangles = scattered_triangles();
  const std::vector<Ray> rays = check_rays();
  Layout layout;
  BuildPlan build;
  std::optional<WidePlan> wide;
  std::vector<RaySlots> traces;
};

enum class Outcome { right, wrong_tree, wrong_hits };

template <class T>
bool same_bits(const GpuExecutor& gpu, const CpuExecutor& cpu, const Slot<T>& slot) {
  const std::vector<T> on_device = gpu.read(slot), by_twins = cpu.read(slot);
  return std::memcmp(on_device.data(), by_twins.data(), slot.bytes()) == 0;
}

bool right_hits(const Device& device, const GpuExecutor& gpu, const CpuExecutor& cpu, const Slot<Hit>& slot) {
  if (rounds_like_the_host(device.properties())) return same_bits(gpu, cpu, slot);
  const std::vector<Hit> on_device = gpu.read(slot), by_twins = cpu.read(slot);
  return compare_nearly(Nearly::hits, std::as_bytes(std::span(by_twins)), std::as_bytes(std::span(on_device)))
      .holds();
}

Outcome run_check(Device& device, const DeviceUse& use, bool lookback,
                  const std::function<void(std::vector<Step>&)>& fault) {
  const CheckPlan plan(device, use, lookback);
  CpuExecutor cpu(plan.layout);
  plan.upload(cpu);
  cpu.run(plan.append(cpu.chain(), true).steps());

  GpuExecutor gpu(device, plan.layout);
  plan.upload(gpu);
  if (!use.builds) {
    gpu.upload(plan.build.nodes, std::span<const Node>(cpu.read(plan.build.nodes)));
    gpu.upload(plan.build.state, std::span<const BuildState>(cpu.read(plan.build.state)));
  }
  Chain chain = plan.append(gpu.chain(), use.builds);
  if (fault) fault(chain.steps());
  gpu.record(chain.steps()).submit_and_wait(check_limit_seconds);

  if (!same_bits(gpu, cpu, plan.build.nodes)) return Outcome::wrong_tree;
  for (const RaySlots& slots : plan.traces) {
    if (!right_hits(device, gpu, cpu, slots.hits)) return Outcome::wrong_hits;
  }
  return gpu.read(plan.build.state)[0].error_word == 0 ? Outcome::right : Outcome::wrong_tree;
}

}  // namespace

bool check_device(Device& device, const DeviceUse& use,
                  const std::function<void(std::vector<Step>&)>& fault) {
  Outcome outcome = run_check(device, use, true, fault);
  if (outcome == Outcome::right) return true;
  if (use.builds) outcome = run_check(device, use, false, fault);
  if (outcome == Outcome::right) return false;
  throw DeviceError("device '" + device.properties().name + "' (" + device.properties().driver +
                    (outcome == Outcome::wrong_tree ? ") computes a wrong tree" : ") finds wrong hits") +
                    " in the self-check; it is not used");
}

}  // namespace coppice
