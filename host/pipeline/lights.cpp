#include "pipeline/lights.h"

#include <stdexcept>
#include <string>

#include "pipeline/scan_plan.h"
#include "pipeline/trace_any.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// Without lookback: places then need nothing of the device that a self-check would have to try.
ScanPlan scan_of(const LightSlots& slots, const TreeSlots& tree, std::uint32_t count) {
  ScanPlan scan;
  scan.options.lookback = false;
  scan.word_count = count;
  scan.source = slots.marks;
  scan.target = slots.places;
  scan.status = slots.scan_status;
  scan.state = tree.state;
  return scan;
}

void append_shading(Chain& chain, const LightSlots& slots, const LitRays& rays, std::uint32_t first,
                    std::uint32_t count, bool shadows, bool points) {
  ShadeLightsArgs args{.triangles = rays.triangles,
                       .material_index = rays.material_index,
                       .materials = rays.materials,
                       .lights = chain.at(slots.sources),
                       .rays = rays.rays,
                       .hits = rays.hits,
                       .marks = {},
                       .places = {},
                       .any_hits = {},
                       .radiance = rays.radiance,
                       .first_light = first,
                       .light_count = count,
                       .ray_count = rays.count,
                       .padding = 0};
  if (shadows) {
    args.marks = chain.at(ScanPlan::words_of(slots.marks));
    args.places = chain.at(ScanPlan::words_of(slots.places));
    args.any_hits = chain.at(slots.any_hits);
  }
  chain.run(stages::shade_lights, args, groups_of(rays.count, SHADE_LIGHTS_GROUP), {shadows, points});
}

void append_shadow_rays(Chain& chain, const TreeSlots& tree, const LightSlots& slots, const LitRays& rays,
                        std::uint32_t light) {
  const auto marks = chain.at(ScanPlan::words_of(slots.marks));
  chain.run(stages::shadow_marks,
            {rays.triangles, rays.material_index, rays.materials, chain.at(slots.sources), rays.rays,
             rays.hits, marks, light, rays.count},
            groups_of(rays.count, SHADOW_MARKS_GROUP));
  append_scan(chain, scan_of(slots, tree, rays.count));
  chain.run(stages::shadow_rays,
            {rays.triangles, chain.at(slots.sources), rays.rays, rays.hits, marks,
             chain.at(ScanPlan::words_of(slots.places)), chain.at(slots.shadow_rays),
             chain.at(slots.shadow_count), light, rays.count},
            groups_of(rays.count, SHADOW_RAYS_GROUP));
}

// As many rays as marks, into the queue that shadow rays have had.
void append_occlusion_rays(Chain& chain, const TreeSlots& tree, const LightSlots& slots,
                           const LitRays& rays) {
  const auto marks = chain.at(ScanPlan::words_of(slots.marks));
  const auto ambient = chain.at(slots.ambient);
  chain.run(stages::occlusion_marks,
            {rays.material_index, rays.materials, ambient, rays.hits, marks, rays.count, 0},
            groups_of(rays.count, OCCLUSION_MARKS_GROUP));
  append_scan(chain, scan_of(slots, tree, rays.count));
  chain.run(stages::occlusion_rays,
            {rays.triangles, ambient, rays.rays, rays.hits, marks, chain.at(ScanPlan::words_of(slots.places)),
             rays.pixels, chain.at(slots.shadow_rays), chain.at(slots.shadow_count), rays.first_ray,
             rays.count, rays.sample_index, 0},
            groups_of(rays.count, OCCLUSION_RAYS_GROUP));
}

void append_ambient(Chain& chain, const LightSlots& slots, const LitRays& rays) {
  chain.run(stages::shade_ambient,
            {rays.material_index, rays.materials, chain.at(slots.ambient), rays.hits,
             chain.at(ScanPlan::words_of(slots.marks)), chain.at(ScanPlan::words_of(slots.places)),
             chain.at(slots.any_hits), rays.radiance, rays.count, 0},
            groups_of(rays.count, SHADE_AMBIENT_GROUP));
}

}  // namespace

LightSlots plan_lights(Layout& layout, const LightCounts& counts, std::uint32_t band_rays) {
  if (counts.lights > MAX_LIGHTS)
    throw std::invalid_argument(std::to_string(counts.lights) + " lights are more than " +
                                std::to_string(MAX_LIGHTS));
  LightSlots slots;
  if (counts.lights > 0) slots.sources = layout.add<LightSource>("lights", counts.lights);
  if (counts.shadows == 0 && !counts.occlusion) return slots;
  slots.marks = layout.add<uvec4>("shadow_marks", scan_quads(band_rays));
  slots.places = layout.add<uvec4>("shadow_places", scan_quads(band_rays));
  slots.scan_status = layout.add<uint>("shadow_scan_status", scan_status_words(band_rays));
  slots.shadow_rays = layout.add<Ray>("shadow_rays", band_rays);
  slots.shadow_count = layout.add<uint>("shadow_count", 1);
  slots.any_hits = layout.add<uint>("shadow_hits", band_rays);
  if (counts.shadows > 0) slots.counters = layout.add<TraceCounters>("shadow_counters", 1);
  if (!counts.occlusion) return slots;
  slots.ambient = layout.add<AmbientLight>("ambient_light", 1);
  slots.occlusion_counters = layout.add<TraceCounters>("occlusion_counters", 1);
  return slots;
}

void append_lights(Chain& chain, const TreeSlots& tree, const LightSlots& slots, const LitRays& rays,
                   const TraceOptions& options) {
  const LightCounts& counts = options.lights;
  const std::uint32_t plain = counts.lights - counts.shadows;
  if (plain > 0) append_shading(chain, slots, rays, 0, plain, false, counts.points);
  AnyHitSlots queue{slots.shadow_rays, slots.any_hits, slots.counters};
  queue.filter.count_at = slots.shadow_count;
  queue.filter.alpha = rays.alpha;
  for (std::uint32_t light = plain; light < counts.lights; ++light) {
    append_shadow_rays(chain, tree, slots, rays, light);
    append_any_hits(chain, tree, queue, rays.count, options);
    append_shading(chain, slots, rays, light, 1, true, counts.points);
  }
  if (!counts.occlusion) return;
  queue.counters = slots.occlusion_counters;
  append_occlusion_rays(chain, tree, slots, rays);
  append_any_hits(chain, tree, queue, rays.count, options);
  append_ambient(chain, slots, rays);
}

}  // namespace coppice
