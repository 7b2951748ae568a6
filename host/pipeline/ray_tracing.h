#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/pace.h"
#include "pipeline/trace_any.h"
#include "pipeline/trace_plan.h"
#include "pipeline/wide_plan.h"
#include "stages/cpu_executor.h"
#include "stages/gpu_executor.h"

namespace coppice {

struct TracedRays {
  std::vector<Hit> hits;
  std::uint64_t hit_count = 0;
  std::uint32_t error_word = 0;
  double ms = 0;  // of the kernels that trace
};

struct TracedAnyHits {
  std::vector<uint> any_hits;  // 1 or 0 each
  std::uint32_t error_word = 0;
  double ms = 0;  // of the kernels that trace
};

// Traces given rays through a tree that the host has, on the device and by the twins.
class RayTracing {
 public:
  // The tree is uploaded once, and with `wide` converted once, for options with a wide tree; `nodes` may be
  // empty for brute force. Throws DeviceError if it does not fit, LayoutError if a slot is too large. The
  // device must outlive it.
  RayTracing(Device& device, std::span<const Node> nodes, std::span<const Triangle> triangles,
             std::uint32_t most_rays, bool wide = false);

  // At most `most_rays` rays: else they throw LayoutError. On the device in submits of bounded time, with
  // Interrupted between two where an InterruptionGuard noted a signal.
  TracedRays on_device(std::span<const Ray> rays, const TraceOptions& options);
  TracedRays by_twins(std::span<const Ray> rays, const TraceOptions& options);

  // Whether each hits anything; in the same submits.
  TracedAnyHits any_on_device(std::span<const Ray> rays, const TraceOptions& options);
  TracedAnyHits any_by_twins(std::span<const Ray> rays, const TraceOptions& options);

  // Rays that leave the hits of `rays`, by stage bounce_rays on the device.
  std::vector<Ray> bounce(std::span<const Ray> rays, const TraceOptions& options, std::uint32_t seed);

 private:
  struct Slots {
    TreeSlots tree;
    std::optional<WidePlan> wide;
    RaySlots rays, bounced;
    AnyHitSlots any;  // of the same rays
  };
  static Slots plan(Layout& layout, std::size_t nodes, std::size_t triangles, std::uint32_t most_rays,
                    bool wide, std::uint32_t max_turns);
  void convert();
  template <class Executor>
  void upload_rays(Executor& executor, std::span<const Ray> rays) const;
  double trace(std::size_t ray_count, const TraceOptions& options);  // ms of the kernels
  template <class Executor>
  TracedAnyHits any_result(Executor& executor, std::size_t ray_count) const;
  Pace& pace_of(const TraceOptions& options);
  template <class Executor>
  TracedRays result(Executor& executor, std::size_t ray_count) const;

  Device& device_;
  std::map<Walk, Pace> paces_;
  BuildState state_{};
  Layout layout_;
  Slots slots_;
  GpuExecutor gpu_;
  CpuExecutor cpu_;
};

}  // namespace coppice
