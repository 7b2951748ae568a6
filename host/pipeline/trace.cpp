#include "pipeline/trace.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr std::uint32_t max_band_rays = 1u << 20;

uvec3 groups_of(std::uint32_t count, std::uint32_t group) { return {divide_up(count, group), 1, 1}; }

}  // namespace

bool can_trace_wide(const TraceOptions& options) {
  return !options.brute_force && options.triangle_test == TRIANGLE_WATERTIGHT &&
         options.box_test == BOX_ROBUST;
}

void append_closest_hits(Chain& chain, const TreeSlots& tree, const RaySlots& slots, std::uint32_t ray_count,
                         const TraceOptions& options) {
  const uvec3 groups = groups_of(ray_count, TRACE_GROUP);
  const auto triangles = chain.at(tree.triangles);
  const auto rays = chain.at(slots.rays);
  const auto hits = chain.at(slots.hits);
  const auto counters = chain.at(slots.counters);
  if (options.wide) {
    if (!can_trace_wide(options))
      throw std::invalid_argument("the wide tree is traced with the watertight and the robust test");
    const TraceWideArgs args{chain.at(tree.wide_nodes),
                             chain.at(tree.wide_counts),
                             chain.at(tree.nodes),
                             triangles,
                             rays,
                             hits,
                             counters,
                             chain.at(tree.state),
                             ray_count,
                             0};
    if (options.packets) {
      chain.run(stages::trace_wide, args, groups_of(ray_count, TRACE_PACKET), {options.max_turns});
    } else {
      chain.run(stages::trace_wide_single, args, groups_of(ray_count, TRACE_BLOCK), {options.max_turns});
    }
    return;
  }
  if (!options.brute_force) {
    chain.run(stages::trace_closest,
              {chain.at(tree.nodes), triangles, rays, hits, counters, chain.at(tree.state), ray_count,
               options.stack_entries, options.triangle_test, options.box_test},
              groups,
              {options.max_turns, options.visits_per_turn, options.stack_entries, options.triangle_test,
               options.box_test});
    return;
  }
  std::uint32_t first = 0;
  do {
    const std::uint32_t count = std::min(BRUTE_FORCE_SLICE, tree.triangle_count - first);
    const bool last = first + count == tree.triangle_count;
    chain.run(stages::trace_brute_force,
              {triangles, rays, hits, counters, ray_count, first, count, last, options.triangle_test, 0},
              groups, {options.triangle_test});
    first += count;
  } while (first < tree.triangle_count);
}

void append_bounce(Chain& chain, const TreeSlots& tree, const RaySlots& slots, const RaySlots& bounced,
                   std::uint32_t ray_count, std::uint32_t seed) {
  chain.run(stages::bounce_rays,
            {chain.at(tree.triangles), chain.at(slots.rays), chain.at(slots.hits), chain.at(bounced.rays),
             chain.at(bounced.hits), ray_count, seed},
            groups_of(ray_count, BOUNCE_RAYS_GROUP));
}

std::array<uint, 256> srgb_thresholds() {
  std::array<uint, 256> thresholds;
  for (int code = 0; code < 256; ++code) {
    const double encoded = (code - 0.5) / 255;
    const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    const float least = code == 0 ? -std::numeric_limits<float>::infinity() : static_cast<float>(linear);
    thresholds[code] = std::bit_cast<uint>(least);
  }
  return thresholds;
}

TracePlan plan_trace(Layout& layout, const TreeSlots& tree, std::uint32_t material_count,
                     const TraceOptions& options) {
  TracePlan plan;
  plan.options = options;
  const std::uint32_t pixels = options.width * options.height;
  plan.band_rays = std::min(pixels, max_band_rays);
  plan.material_index = layout.add<uint>("material_index", tree.triangle_count);
  plan.materials = layout.add<SurfaceMaterial>("materials", material_count);
  plan.film = layout.add<Film>("film", 1);
  plan.lighting = layout.add<Lighting>("lighting", 1);
  plan.srgb_thresholds = layout.add<uint>("srgb_thresholds", 256);
  plan.image = layout.add<uint>("image", pixels);
  plan.counters = layout.add<TraceCounters>("counters", 1);
  plan.rays = layout.add<Ray>("rays", plan.band_rays);
  plan.hits = layout.add<Hit>("hits", plan.band_rays);
  plan.radiance = layout.add<vec3>("radiance", plan.band_rays);
  return plan;
}

void append_trace(Chain& chain, const TreeSlots& tree, const TracePlan& plan) {
  chain.clear(plan.counters);
  const auto rays = chain.at(plan.rays);
  const auto hits = chain.at(plan.hits);
  const auto radiance = chain.at(plan.radiance);
  const auto pixels = static_cast<std::uint32_t>(plan.image.count);
  for (std::uint32_t first = 0; first < pixels; first += plan.band_rays) {
    const std::uint32_t count = std::min(plan.band_rays, pixels - first);
    for (std::uint32_t sample = 0; sample < plan.options.samples; ++sample) {
      chain.run(stages::camera_rays, {chain.at(plan.film), rays, hits, first, count, sample, 0},
                groups_of(count, CAMERA_RAYS_GROUP));
      append_closest_hits(chain, tree, plan, count, plan.options);
      chain.run(stages::shade,
                {chain.at(tree.triangles), chain.at(plan.material_index), chain.at(plan.materials),
                 chain.at(plan.lighting), rays, hits, radiance, count, sample},
                groups_of(count, SHADE_GROUP), {plan.options.directional_light});
    }
    chain.run(
        stages::resolve,
        {chain.at(plan.film), radiance, chain.at(plan.srgb_thresholds), chain.at(plan.image), first, count},
        groups_of(count, RESOLVE_GROUP));
  }
}

}  // namespace coppice
