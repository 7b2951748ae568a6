#include "pipeline/trace_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pipeline/alpha_args.h"
#include "pipeline/trace_pieces.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr std::uint32_t max_band_rays = 1u << 20;

void append_walk(Chain& chain, const TreeSlots& tree, const RaySlots& slots, const RayRange& range,
                 const TraceOptions& options) {
  const auto triangles = chain.at(tree.triangles);
  const auto rays = chain.at(slots.rays, range.first);
  const auto hits = chain.at(slots.hits, range.first);
  const auto counters = chain.at(slots.counters);
  const RayFilter& filter = slots.filter;
  if (range.first != 0 && filter.count_at.count != 0)
    throw std::invalid_argument("a count on the device is of all rays, not of a range");
  const auto flags = address_or_null(chain, filter.primitive_flags);
  const auto masks = address_or_null(chain, filter.ray_masks, range.first);
  const auto count_at = address_or_null(chain, filter.count_at);
  const auto ray_steps = address_or_null(chain, slots.ray_steps, range.first);
  const bool counts_rays = slots.ray_steps.count != 0;
  if (!is_wide(options.walk)) {
    const TraceClosestArgs args{chain.at(tree.nodes),
                                triangles,
                                rays,
                                hits,
                                counters,
                                chain.at(tree.state),
                                flags,
                                masks,
                                count_at,
                                ray_steps,
                                range.count,
                                filter.ray_mask,
                                options.stack_entries,
                                options.triangle_test,
                                options.box_test,
                                0};
    const TraceClosestConstants constants{options.max_turns,
                                          options.visits_per_turn,
                                          options.stack_entries,
                                          options.triangle_test,
                                          options.box_test,
                                          filter.masks(),
                                          counts_rays};
    return run_trace(chain, stages::trace_closest, stages::trace_closest_alpha, filter.alpha, args,
                     counted_groups(range.count, TRACE_GROUP, count_at), constants);
  }
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
                           flags,
                           masks,
                           count_at,
                           ray_steps,
                           range.count,
                           filter.ray_mask};
  const TraceWideConstants constants{options.max_turns, filter.masks(), counts_rays};
  if (options.walk == Walk::wide_packets) {
    run_trace(chain, stages::trace_wide, stages::trace_wide_alpha, filter.alpha, args,
              counted_groups(range.count, TRACE_PACKET, count_at), constants);
  } else {
    run_trace(chain, stages::trace_wide_single, stages::trace_wide_single_alpha, filter.alpha, args,
              counted_groups(range.count, TRACE_BLOCK, count_at), constants);
  }
}

// One slice of the triangles; returns how many tests it makes.
std::uint64_t append_slice(Chain& chain, const TreeSlots& tree, const RaySlots& slots, const RayRange& range,
                           const TraceOptions& options) {
  const std::uint32_t count = std::min(BRUTE_FORCE_SLICE, tree.triangle_count - range.next_triangle);
  const bool last = range.next_triangle + count == tree.triangle_count;
  chain.run(
      stages::trace_brute_force,
      {chain.at(tree.triangles), chain.at(slots.rays, range.first), chain.at(slots.hits, range.first),
       chain.at(slots.counters), range.count, range.next_triangle, count, last, options.triangle_test, 0},
      groups_of(range.count, TRACE_GROUP), {options.triangle_test});
  return std::uint64_t{range.count} * std::max(count, 1u);
}

ShowSlots plan_show(Layout& layout, const TreeSlots& tree, uint view) {
  ShowSlots slots;
  slots.colour_map = layout.add<vec3>("colour_map", SHOW_MAP_COLOURS);
  slots.scale = layout.add<ShowScale>("show_scale", 1);
  slots.range = layout.add<ShowRange>("show_range", 1);
  if (view == SHOW_RANKS || view == SHOW_GROUPS)
    slots.primitive_values = layout.add<uint>("primitive_values", tree.triangle_count);
  return slots;
}

}  // namespace

float ToneMapping::exposure() const { return static_cast<float>(std::exp2(stops)); }

bool keeps_radiance(const TraceOptions& options) {
  return options.samples > 1 || options.show != SHOW_COLOR || options.lights.any() ||
         options.textures.textures > 0 || options.lens || options.paths.any() || options.tone.changes() ||
         keeps_whole_radiance(options);
}

bool keeps_whole_radiance(const TraceOptions& options) { return options.keep_radiance || options.keep_noise; }

bool can_trace_wide(const TraceOptions& options) {
  return options.walk != Walk::brute_force && options.triangle_test == TRIANGLE_WATERTIGHT &&
         options.box_test == BOX_ROBUST;
}

bool traces_pixels(const TraceOptions& options) {
  return options.walk == Walk::wide_packets && can_trace_wide(options) && !keeps_radiance(options) &&
         !options.keep_hits && options.alpha.maps == 0;
}

TraceCounts counts_of(const TraceCounters& counters) {
  const auto wide = [](uvec2 words) { return std::uint64_t{words.y} << 32 | words.x; };
  return {wide(counters.rays), wide(counters.hits), wide(counters.steps)};
}

bool has_closest_hits(const TreeSlots& tree, const RayRange& range, const TraceOptions& options) {
  return range.next_triangle >= (options.walk == Walk::brute_force ? std::max(tree.triangle_count, 1u) : 1u);
}

void append_misses(Chain& chain, const RaySlots& slots, std::uint32_t ray_count) {
  chain.run(stages::trace_misses,
            {chain.at(slots.rays), chain.at(slots.hits), address_or_null(chain, slots.filter.count_at),
             ray_count, 0},
            groups_of(ray_count, TRACE_GROUP));
}

std::uint64_t append_closest_hits(Chain& chain, const TreeSlots& tree, const RaySlots& slots, RayRange& range,
                                  const TraceOptions& options, std::uint64_t work) {
  const RayFilter& filter = slots.filter;
  if (options.walk == Walk::brute_force &&
      (filter.masks() || filter.alpha.any() || filter.count_at.count != 0))
    throw std::invalid_argument("brute force takes no masks, no alpha and no count on the device");
  if (options.walk != Walk::brute_force) {
    append_walk(chain, tree, slots, range, options);
    range.next_triangle = std::max(tree.triangle_count, 1u);
    return range.count;
  }
  std::uint64_t appended = 0;
  do {
    appended += append_slice(chain, tree, slots, range, options);
    range.next_triangle +=
        std::max(std::min(BRUTE_FORCE_SLICE, tree.triangle_count - range.next_triangle), 1u);
  } while (!has_closest_hits(tree, range, options) &&
           appended + std::uint64_t{range.count} * BRUTE_FORCE_SLICE <= work);
  return appended;
}

void append_closest_hits(Chain& chain, const TreeSlots& tree, const RaySlots& slots, std::uint32_t ray_count,
                         const TraceOptions& options) {
  RayRange range{0, ray_count};
  append_closest_hits(chain, tree, slots, range, options, ~std::uint64_t{0});
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

const Slot<TraceCounters>& shadow_counters(const TracePlan& plan) {
  return plan.options.paths.any() ? plan.paths.light_counters : plan.lights.counters;
}

TracePlan plan_trace(Layout& layout, const TreeSlots& tree, std::uint32_t material_count,
                     const TraceOptions& options) {
  if (options.show == SHOW_STEPS && options.walk == Walk::brute_force)
    throw std::invalid_argument("brute force visits no nodes");
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
  const std::uint32_t kept_rays = traces_pixels(options) ? 0 : plan.band_rays;
  plan.rays = layout.add<Ray>("rays", kept_rays);
  plan.hits = layout.add<Hit>("hits", kept_rays);
  const std::uint32_t kept_radiance = keeps_whole_radiance(options) ? pixels : plan.band_rays;
  plan.radiance = layout.add<vec3>("radiance", keeps_radiance(options) ? kept_radiance : 0);
  if (options.keep_noise) plan.noise = plan_noise(layout, plan.band_rays, pixels, options.adaptive);
  if (options.show == SHOW_COLOR) {
    plan.lights = plan_lights(layout, options.lights, plan.band_rays);
    plan.filter.alpha = plan_alpha(layout, options.alpha, tree.triangle_count);
    plan.textures =
        plan_textures(layout, options.textures, tree.triangle_count, material_count, plan.band_rays);
    plan.paths = plan_paths(layout, options.paths, tree.triangle_count, material_count, plan.band_rays);
  }
  if (options.show != SHOW_COLOR) plan.show = plan_show(layout, tree, options.show);
  if (options.show == SHOW_STEPS) plan.ray_steps = layout.add<uint>("ray_steps", plan.band_rays);
  return plan;
}

TracePlan plan_refined(Layout& layout, const TracePlan& plan) {
  TracePlan refined = plan;
  refined.options.keep_noise = true;
  refined.options.resolves = false;
  if (plan.rays.count == 0) {
    refined.rays = layout.add<Ray>("refined_rays", plan.band_rays);
    refined.hits = layout.add<Hit>("refined_hits", plan.band_rays);
  }
  const auto pixels = static_cast<std::uint32_t>(plan.image.count);
  refined.radiance = layout.add<vec3>("refined_radiance", pixels);
  refined.noise = plan_noise(layout, plan.band_rays, pixels, false);
  return refined;
}

void append_resolve(Chain& chain, const TracePlan& plan, Vec3Buffer radiance, std::uint32_t first_pixel,
                    std::uint32_t count) {
  const ToneMapping tone = plan.options.show == SHOW_COLOR ? plan.options.tone : ToneMapping{};
  const Slot<uint>& counts = plan.noise.sample_counts;
  const bool has_counts = counts.count > 0;
  chain.run(stages::resolve,
            {chain.at(plan.film), radiance, address_or_null(chain, counts, first_pixel),
             chain.at(plan.srgb_thresholds), chain.at(plan.image), first_pixel, count,
             std::bit_cast<uint>(tone.exposure()), tone.curve},
            groups_of(count, RESOLVE_GROUP), {has_counts, tone.curve, tone.exposure() != 1});
}

void append_resolved(Chain& chain, const TracePlan& plan) {
  const auto pixels = static_cast<std::uint32_t>(plan.image.count);
  for (std::uint32_t first = 0; first < pixels; first += plan.band_rays)
    append_resolve(chain, plan, chain.at(plan.radiance, first), first,
                   std::min(plan.band_rays, pixels - first));
}

void append_trace(Chain& chain, const TreeSlots& tree, const TracePlan& plan) {
  TracePieces pieces(tree, plan);
  while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
}

}  // namespace coppice
