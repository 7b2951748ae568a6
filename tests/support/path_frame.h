#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "render/film.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"
#include "support/traced_frame.h"

namespace coppice {

// Pictures of paths of light, as radiance.

struct PathView {
  std::uint32_t width = 24, height = 18, samples = 1;
  Walk walk = Walk::binary;
  const char* changes = "";
  std::uint64_t work = ~std::uint64_t{0};
};

inline FrameOptions path_options(const PathView& view) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(view.width, view.height)};
  options.trace.walk = view.walk;
  options.trace.samples = view.samples;
  options.trace.keep_radiance = true;
  return options;
}

// Outside of a scene it is dark.
inline SceneArrays dark_arrays(const Scene& scene, const PathView& view) {
  SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(view.changes)));
  arrays.lighting.sky_horizon = arrays.lighting.sky_zenith = vec3(0);
  return arrays;
}

struct PathPicture {
  std::vector<vec3> radiance;  // the mean of the samples
  TraceCounts bounced, light;
  PathCounters lobes{};
};

inline PathPicture path_picture(const Scene& scene, const SceneArrays& arrays, const PathView& view) {
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, path_options(view));
  GpuExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, view.width, view.height, view.samples));
  trace_frame_in_pieces(executor, plan, std::min<std::uint64_t>(view.work, 1u << 16));
  PathPicture pictured{executor.read(plan.trace.radiance),
                       counts_of(executor.read(plan.trace.paths.bounce_counters)[0]),
                       counts_of(executor.read(plan.trace.paths.light_counters)[0]),
                       executor.read(plan.trace.paths.lobe_counters)[0]};
  for (vec3& radiance : pictured.radiance) radiance /= static_cast<float>(view.samples);
  return pictured;
}

inline PathPicture path_picture(const Scene& scene, const PathView& view) {
  return path_picture(scene, dark_arrays(scene, view), view);
}

inline glm::dvec3 mean_radiance_of(const std::vector<vec3>& radiance) {
  glm::dvec3 sum(0);
  for (const vec3& r : radiance) sum += glm::dvec3(r.x, r.y, r.z);
  return sum / static_cast<double>(radiance.size());
}

// Empty where there is none.
inline std::string difference_of(const Scene& scene, const SceneArrays& arrays, const PathView& view) {
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, path_options(view));
  LockstepExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, view.width, view.height, view.samples));
  const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
  if (!difference) return "";
  return difference->stage + " " + difference->slot + " " + std::to_string(difference->index);
}

inline std::string difference_of(const Scene& scene, const PathView& view) {
  return difference_of(scene, dark_arrays(scene, view), view);
}

}  // namespace coppice
