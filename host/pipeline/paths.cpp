#include "pipeline/paths.h"

#include "pipeline/scan_plan.h"
#include "pipeline/trace_any.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// The queue of one bounce.
struct PathQueue {
  RayBuffer rays;
  HitBuffer hits;
};

class PathChain {
 public:
  PathChain(Chain& chain, const TreeSlots& tree, const PathSlots& slots, const TextureSlots& textures,
            const CameraPaths& camera, const TraceOptions& options)
      : chain_(chain),
        tree_(tree),
        slots_(slots),
        textures_(textures),
        camera_(camera),
        options_(options),
        counts_(options.paths),
        marks_(chain.at(ScanPlan::words_of(slots.marks))),
        places_(chain.at(ScanPlan::words_of(slots.places))) {}

  void append() {
    chain_.run(stages::path_start,
               {chain_.at(slots_.paths), chain_.at(slots_.queue_count), camera_.radiance, camera_.pixels,
                camera_.first_ray, camera_.count, camera_.summed_samples, 0},
               groups());
    PathQueue queue{camera_.rays, camera_.hits};
    for (bounce_ = 0;; ++bounce_) {
      if (counts_.fog) append_fog(queue);
      append_surfaces(queue);
      if (counts_.choices > 0) append_lights(queue);
      if (bounce_ == counts_.bounces) return;
      append_bounce(queue);
      queue = {chain_.at(slots_.rays), chain_.at(slots_.hits)};
      append_hits();
    }
  }

 private:
  uvec3 groups() const { return groups_of(camera_.count, PATH_GROUP); }
  bool has_environment() const { return counts_.environment_side > 0; }
  PathBsdfConstants lobes() const {
    const auto has = [&](uint lobe) { return (counts_.lobes & lobe) != 0 ? 1u : 0u; };
    return {has(PATH_LOBE_DIFFUSE), has(PATH_LOBE_REFLECTS), has(PATH_LOBE_TRANSMITS)};
  }

  // Textures are read where rays arrive, at the level of a camera's ray of that length.
  void append_surfaces(const PathQueue& queue) {
    const bool textured = options_.textures.textures > 0;
    const auto hit_materials = chain_.at(textures_.hit_materials);
    if (textured)
      append_textures(chain_, textures_,
                      {camera_.film, camera_.triangles, camera_.path_index, queue.rays, queue.hits,
                       hit_materials, chain_.at(slots_.queue_count), camera_.count});
    chain_.run(
        stages::path_surfaces,
        {camera_.triangles, textured ? UintBuffer{} : camera_.path_index,
         textured ? hit_materials : chain_.at(slots_.materials), camera_.path_index,
         chain_.at(slots_.path_materials), address_or_null(chain_, slots_.emitter_probability),
         camera_.lighting, queue.rays, queue.hits, chain_.at(slots_.paths), chain_.at(slots_.surfaces),
         camera_.radiance, chain_.at(slots_.queue_count), chain_.at(slots_.surroundings), camera_.count,
         (counts_.bounces_light ? PATH_BOUNCES_LIGHT : 0) | (has_environment() ? PATH_HAS_ENVIRONMENT : 0)},
        groups(), {counts_.bounces_light, has_environment()});
  }

  void append_lights(const PathQueue& queue) {
    const PathBsdfConstants sampled = lobes();
    chain_.run(
        stages::path_lights,
        {camera_.triangles, address_or_null(chain_, slots_.lights), chain_.at(slots_.choices), queue.rays,
         queue.hits, chain_.at(slots_.paths), chain_.at(slots_.surfaces), chain_.at(slots_.surroundings),
         chain_.at(slots_.marked_rays), chain_.at(slots_.light_radiance), marks_, camera_.radiance,
         chain_.at(slots_.queue_count), camera_.count, counts_.choices, camera_.sample_index, bounce_,
         counts_.lobes | (bounce_ == counts_.bounces ? PATH_LAST_BOUNCE : 0), counts_.fog},
        groups(),
        {sampled.diffuse_lobe, sampled.reflects, sampled.transmits, has_environment(), counts_.fog});
    append_light_rays();
  }

  void append_fog(const PathQueue& queue) {
    chain_.run(stages::path_fog,
               {camera_.triangles, address_or_null(chain_, slots_.lights),
                address_or_null(chain_, slots_.choices), chain_.at(slots_.surroundings), queue.rays,
                queue.hits, chain_.at(slots_.paths), chain_.at(slots_.marked_rays),
                chain_.at(slots_.light_radiance), marks_, camera_.radiance, chain_.at(slots_.queue_count),
                camera_.count, counts_.choices, camera_.sample_index, bounce_, counts_.bounces_light, 0},
               groups(), {has_environment()});
    if (counts_.choices > 0) append_light_rays();
  }

  // Of marked rays to lights what reaches the pixel, where anything may be in their way.
  void append_light_rays() {
    if (!counts_.shadows) return;
    append_queue({}, {}, chain_.at(slots_.light_rays), {}, chain_.at(slots_.light_count));
    AnyHitSlots rays{slots_.light_rays, slots_.any_hits, slots_.light_counters, {}};
    rays.filter.count_at = slots_.light_count;
    rays.filter.alpha = camera_.alpha;
    append_any_hits(chain_, tree_, rays, camera_.count, options_);
    chain_.run(
        stages::path_light_add,
        {chain_.at(slots_.paths), marks_, places_, chain_.at(slots_.any_hits),
         chain_.at(slots_.light_radiance), camera_.radiance, chain_.at(slots_.queue_count), camera_.count, 0},
        groups());
  }

  void append_bounce(const PathQueue& queue) {
    chain_.run(
        stages::path_bounce,
        {camera_.triangles, camera_.path_index, chain_.at(slots_.path_materials), queue.rays, queue.hits,
         chain_.at(slots_.paths), chain_.at(slots_.surfaces), chain_.at(slots_.marked_rays),
         chain_.at(slots_.bounced_paths), marks_, chain_.at(slots_.lobe_counters),
         chain_.at(slots_.queue_count), camera_.count, camera_.sample_index, bounce_, counts_.lobes},
        groups(), lobes());
    append_queue(chain_.at(slots_.bounced_paths), chain_.at(slots_.paths), chain_.at(slots_.rays),
                 chain_.at(slots_.hits), chain_.at(slots_.queue_count));
  }

  // Bounces go every way: rays that are neighbours in a packet have little in common.
  void append_hits() {
    RaySlots rays{slots_.rays, slots_.hits, slots_.bounce_counters, {}, {}};
    rays.filter.count_at = slots_.queue_count;
    rays.filter.alpha = camera_.alpha;
    TraceOptions options = options_;
    if (options.walk == Walk::wide_packets) options.walk = Walk::wide_single;
    append_closest_hits(chain_, tree_, rays, camera_.count, options);
  }

  void append_queue(PathBuffer marked_paths, PathBuffer paths, RayBuffer rays, HitBuffer hits,
                    UintBuffer count) {
    ScanPlan scan;
    scan.options.lookback = false;  // as of shadow rays
    scan.word_count = camera_.count;
    scan.source = slots_.marks;
    scan.target = slots_.places;
    scan.status = slots_.scan_status;
    scan.state = tree_.state;
    append_scan(chain_, scan);
    chain_.run(stages::path_queue,
               {marks_, places_, chain_.at(slots_.marked_rays), marked_paths, paths, hits, rays, count,
                camera_.count, 0},
               groups());
  }

  Chain& chain_;
  const TreeSlots& tree_;
  const PathSlots& slots_;
  const TextureSlots& textures_;
  const CameraPaths& camera_;
  const TraceOptions& options_;
  const PathCounts counts_;
  UintBuffer marks_, places_;
  std::uint32_t bounce_ = 0;
};

}  // namespace

LobeCounts counts_of(const PathCounters& counters) {
  const auto wide = [](uvec2 words) { return std::uint64_t{words.y} << 32 | words.x; };
  return {wide(counters.diffuse), wide(counters.reflected), wide(counters.transmitted)};
}

PathSlots plan_paths(Layout& layout, const PathCounts& counts, std::uint32_t triangle_count,
                     std::uint32_t material_count, std::uint32_t band_rays) {
  PathSlots slots;
  if (!counts.any()) return slots;
  slots.materials = layout.add<SurfaceMaterial>("path_colours", material_count);
  slots.path_materials = layout.add<PathMaterial>("path_materials", material_count);
  slots.surroundings = layout.add<Surrounding>("surroundings", surrounding_count(counts));
  slots.lights = layout.add<LightSource>("path_lights", counts.lights);
  slots.choices = layout.add<LightChoice>("light_choices", counts.choices);
  slots.emitter_probability = layout.add<float>("emitter_probability", counts.emitters ? triangle_count : 0);
  slots.paths = layout.add<Path>("paths", band_rays);
  slots.bounced_paths = layout.add<Path>("bounced_paths", band_rays);
  slots.rays = layout.add<Ray>("path_rays", band_rays);
  slots.light_rays = layout.add<Ray>("light_rays", band_rays);
  slots.marked_rays = layout.add<Ray>("marked_rays", band_rays);
  slots.hits = layout.add<Hit>("path_hits", band_rays);
  slots.surfaces = layout.add<SurfacePoint>("surfaces", band_rays);
  slots.light_radiance = layout.add<vec3>("light_radiance", band_rays);
  slots.marks = layout.add<uvec4>("path_marks", scan_quads(band_rays));
  slots.places = layout.add<uvec4>("path_places", scan_quads(band_rays));
  slots.scan_status = layout.add<uint>("path_scan_status", scan_status_words(band_rays));
  slots.queue_count = layout.add<uint>("queue_count", 1);
  slots.light_count = layout.add<uint>("light_count", 1);
  slots.any_hits = layout.add<uint>("light_hits", band_rays);
  slots.bounce_counters = layout.add<TraceCounters>("bounce_counters", 1);
  slots.lobe_counters = layout.add<PathCounters>("lobe_counters", 1);
  slots.light_counters = layout.add<TraceCounters>("light_counters", 1);
  return slots;
}

void append_paths(Chain& chain, const TreeSlots& tree, const PathSlots& slots, const TextureSlots& textures,
                  const CameraPaths& camera, const TraceOptions& options) {
  PathChain(chain, tree, slots, textures, camera, options).append();
}

}  // namespace coppice
