#include <algorithm>
#include <initializer_list>
#include <numeric>

#include "measure/effects_report.h"
#include "measure/measure_build.h"
#include "render/frame.h"
#include "stages/stages.h"

namespace coppice {

namespace {

using Kernel = RecordedPicture::Kernel;

// Of which effect stages are that several take.
struct Sharing {
  Effect queue = Effect::shadows;        // whose rays the queue has then
  Effect plain_lights = Effect::lights;  // what shades those without shadows
  bool paths = false;                    // which scan for themselves, too
};

uint lobe_of(Effect effect) {
  if (effect == Effect::reflection) return PATH_LOBE_REFLECTS;
  if (effect == Effect::refraction) return PATH_LOBE_TRANSMITS;
  return effect == Effect::global_illumination ? PATH_LOBE_DIFFUSE : 0;
}

// That an effect has alone.
std::uint64_t rays_of(const FrameReport& report, Effect effect) {
  if (effect == Effect::reflection) return report.lobes.reflected;
  if (effect == Effect::refraction) return report.lobes.transmitted;
  if (effect == Effect::global_illumination) return report.lobes.diffuse;
  if (effect == Effect::ambient_occlusion) return report.occlusion.rays;
  const bool lights = effect == Effect::lights || effect == Effect::shadows || effect == Effect::emission ||
                      effect == Effect::environment || effect == Effect::fog;
  return lights ? report.shadow.rays : 0;
}

// Whether a step would not be there, or not as it is, without this effect.
bool belongs_to(const Step& step, Effect effect, const Sharing& sharing) {
  if (effect == Effect::depth_of_field) {
    const CameraRaysArgs* const rays = args_of(step, stages::camera_rays);
    return rays && rays->has_lens != 0;
  }
  if (effect == Effect::textures) return stage_of(step) == &stages::texture_hits;
  if (effect == Effect::fog) return stage_of(step) == &stages::path_fog;
  if (const PathSurfacesArgs* const surfaces = args_of(step, stages::path_surfaces))
    return (effect == Effect::emission && surfaces->emitter_probability.value != 0) ||
           (effect == Effect::environment && (surfaces->flags & PATH_HAS_ENVIRONMENT) != 0);
  if (const PathBounceArgs* const bounce = args_of(step, stages::path_bounce))
    return (bounce->lobes & lobe_of(effect)) != 0;
  const ShadeLightsArgs* const shading = args_of(step, stages::shade_lights);
  if (shading) return effect == (shading->marks.value != 0 ? Effect::shadows : sharing.plain_lights);
  const StageDeclaration* const stage = stage_of(step);
  const auto is_one_of = [&](std::initializer_list<const StageDeclaration*> own) {
    return std::ranges::find(own, stage) != own.end();
  };
  if (effect == Effect::alpha)
    return is_one_of({&stages::trace_closest_alpha, &stages::trace_wide_alpha,
                      &stages::trace_wide_single_alpha, &stages::trace_any_alpha,
                      &stages::trace_wide_any_alpha});
  if (effect == Effect::shadows &&
      is_one_of({&stages::shadow_marks, &stages::shadow_rays, &stages::path_light_add}))
    return true;
  if (effect == Effect::ambient_occlusion &&
      is_one_of({&stages::occlusion_marks, &stages::occlusion_rays, &stages::shade_ambient}))
    return true;
  if (effect != sharing.queue) return false;
  return is_one_of({&stages::trace_any, &stages::trace_wide_any, &stages::trace_any_alpha,
                    &stages::trace_wide_any_alpha}) ||
         (!sharing.paths && is_one_of({&stages::scan_tile_sums, &stages::prefix_scan}));
}

void count_kernel(std::vector<Kernel>& kernels, const char* name) {
  const auto known = std::ranges::find(kernels, name, &Kernel::name);
  if (known != kernels.end())
    ++known->dispatches;
  else
    kernels.push_back({name, 1});
}

std::uint32_t dispatches_of(const std::vector<Kernel>& kernels, const std::string& name) {
  const auto known = std::ranges::find(kernels, name, &Kernel::name);
  return known == kernels.end() ? 0 : known->dispatches;
}

// What is in the first and not in the second.
std::vector<Kernel> less(const std::vector<Kernel>& kernels, const std::vector<Kernel>& others) {
  std::vector<Kernel> rest;
  for (const Kernel& kernel : kernels) {
    const std::uint32_t other = dispatches_of(others, kernel.name);
    if (kernel.dispatches > other) rest.push_back({kernel.name, kernel.dispatches - other});
  }
  return rest;
}

double ms_of(const KernelTable& table, const std::string& name) {
  const auto row = std::ranges::find(table.rows, name, &KernelTime::name);
  return row == table.rows.end() ? 0 : row->ms;
}

double ms_of_all(const KernelTable& table) {
  double ms = 0;
  for (const KernelTime& row : table.rows) ms += row.ms;
  return ms;
}

// By the kernels of which one picture has more than the other, and the one that rays through a lens are of;
// by all of them where an effect shares each of its own with another.
std::optional<double> ms_between(const EffectCost& cost, const KernelTable& with,
                                 const KernelTable& without) {
  if (with.untimed || without.untimed) return std::nullopt;
  if (cost.shares_kernels()) return ms_of_all(with) - ms_of_all(without);
  double ms = 0;
  for (const std::vector<Kernel>* const kernels : {&cost.kernels, &cost.instead_of}) {
    for (const Kernel& kernel : *kernels) ms += ms_of(with, kernel.name) - ms_of(without, kernel.name);
  }
  if (cost.effect == Effect::depth_of_field)
    ms += ms_of(with, stages::camera_rays.name) - ms_of(without, stages::camera_rays.name);
  return ms;
}

}  // namespace

RecordedPicture recorded_picture(const SceneArrays& arrays, const FrameOptions& options) {
  Layout layout(~std::uint64_t{0});
  const FramePlan plan = plan_frame(layout, arrays, options);
  std::vector<std::uint64_t> addresses;
  for (std::uint64_t block = 1; block <= layout.block_bytes().size(); ++block)
    addresses.push_back(block << 48);
  Chain chain(addresses);
  TracePieces pieces = plan.pieces(plan.trace);
  while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
  RecordedPicture recorded;
  recorded.device_bytes = device_bytes(layout);
  for (const SlotListing& slot : layout.slots()) recorded.slots.push_back(slot.name);
  Sharing sharing;
  sharing.paths = plan.trace.options.paths.any();
  // The one light that else is part of the materials.
  const LightCounts& lights = plan.trace.options.lights;
  if (lights.occlusion && lights.lights == 1 && !lights.points)
    sharing.plain_lights = Effect::ambient_occlusion;
  for (const Step& step : chain.steps()) {
    if (stage_of(step) == &stages::shadow_marks) sharing.queue = Effect::shadows;
    if (stage_of(step) == &stages::occlusion_marks) sharing.queue = Effect::ambient_occlusion;
    if (stage_of(step)) count_kernel(recorded.kernels, stage_of(step)->name);
    for (std::size_t i = 0; i < effect_count; ++i)
      recorded.effect_steps[i] += belongs_to(step, static_cast<Effect>(i), sharing);
  }
  return recorded;
}

EffectsReport measure_effects(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                              const FrameRuns& given) {
  FrameRuns frame = given;
  frame.split = true;
  const EffectSet effects = effects_of(scene, frame.effects);
  const auto recorded = [&](const SceneArrays& with) {
    FrameOptions options{.trace = frame.trace};
    if (frame.builder.on_device()) options.build = device.build_options(frame.builder.least_build_options());
    return recorded_picture(with, options);
  };
  const RecordedPicture all = recorded(arrays);
  const FrameReport with = measure_frame(device, scene, arrays, frame);
  EffectsReport report{scene.name, with.trace_device, with.trace_ms, with.rays, {}};
  for (std::size_t i = 0; i < effect_count; ++i) {
    const Effect effect = static_cast<Effect>(i);
    EffectCost cost{.effect = effect, .state = effects.of(effect), .own_steps = all.effect_steps[i]};
    // Counted, where they are off, too.
    if (effect == Effect::shadows || effect == Effect::ambient_occlusion || lobe_of(effect) != 0)
      cost.rays = rays_of(with, effect);
    if (cost.state.on) {
      FrameRuns other = frame;
      other.effects = frame.effects.but(effect, false);
      const SceneArrays other_arrays = scene_arrays(scene, effects_of(scene, other.effects));
      const RecordedPicture rest = recorded(other_arrays);
      cost.kernels = less(all.kernels, rest.kernels);
      cost.instead_of = less(rest.kernels, all.kernels);
      cost.bytes = static_cast<std::int64_t>(all.device_bytes) - static_cast<std::int64_t>(rest.device_bytes);
      const FrameReport without = measure_frame(device, scene, other_arrays, other);
      cost.rays = rays_of(with, effect) - std::min(rays_of(with, effect), rays_of(without, effect));
      cost.ms = ms_between(cost, with.kernels, without.kernels);
    }
    report.costs.push_back(std::move(cost));
  }
  return report;
}

}  // namespace coppice
