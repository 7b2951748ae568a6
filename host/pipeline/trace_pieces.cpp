#include "pipeline/trace_pieces.h"

#include <algorithm>

#include "stages/stages.h"

namespace coppice {

namespace {

// Of the least step: a ray, or its tests of one slice of the triangles.
std::uint64_t step_work(const TreeSlots& tree, const TraceOptions& options) {
  return options.walk == Walk::brute_force ? std::clamp(tree.triangle_count, 1u, BRUTE_FORCE_SLICE) : 1;
}

RayRange next_range(const TreeSlots& tree, const TraceOptions& options, std::uint32_t first,
                    std::uint32_t end, std::uint64_t work) {
  return {first, std::min(range_rays(tree, options, work), end - first), 0};
}

bool has_room(const TreeSlots& tree, const TraceOptions& options, std::uint64_t appended,
              std::uint64_t work) {
  if (appended == 0) return true;
  return appended < work && (work - appended) / step_work(tree, options) >= RANGE_RAYS;
}

// Without the first elements.
template <class T>
void drop_first(Slot<T>& slot, std::uint32_t count) {
  if (slot.count == 0) return;
  slot.place.offset += count * sizeof(T);
  slot.count -= count;
}

}  // namespace

std::uint32_t range_rays(const TreeSlots& tree, const TraceOptions& options, std::uint64_t work) {
  constexpr std::uint64_t most = 1u << 30;
  const std::uint64_t rays = std::min(work / step_work(tree, options), most);
  return static_cast<std::uint32_t>(std::max<std::uint64_t>(rays / RANGE_RAYS, 1)) * RANGE_RAYS;
}

std::uint64_t work_of(const TreeSlots& tree, const TraceOptions& options, std::uint64_t rays) {
  return rays * (options.walk == Walk::brute_force ? std::max(tree.triangle_count, 1u) : 1);
}

std::uint64_t AnyHitPieces::append(Chain& chain, std::uint64_t work) {
  const std::uint32_t count = std::min(range_rays(tree_, options_, work), ray_count_);
  append_any_hits(chain, tree_, slots_, count, options_);
  drop_first(slots_.rays, count);
  drop_first(slots_.any_hits, count);
  drop_first(slots_.filter.ray_masks, count);
  ray_count_ -= count;
  return count;
}

std::uint64_t HitPieces::append(Chain& chain, std::uint64_t work) {
  std::uint64_t appended = 0;
  while (!done() && has_room(tree_, options_, appended, work)) {
    if (range_.count == 0) range_ = next_range(tree_, options_, range_.first, ray_count_, work - appended);
    appended += append_closest_hits(chain, tree_, slots_, range_, options_, work - appended);
    if (!has_closest_hits(tree_, range_, options_)) break;
    range_ = {range_.first + range_.count, 0, 0};
  }
  return appended;
}

std::uint32_t TracePieces::band_rays() const {
  return std::min(plan_.band_rays, traced_pixels() - band_first_);
}

void TracePieces::open_range(Chain& chain, std::uint64_t work) {
  range_ = next_range(tree_, plan_.options, range_.first, band_rays(), work);
  if (traces_pixels(plan_.options)) return;
  chain.run(stages::camera_rays,
            {chain.at(plan_.film), chain.at(plan_.rays, range_.first), chain.at(plan_.hits, range_.first),
             address_or_null(chain, plan_.traced_pixels, band_first_ + range_.first),
             band_first_ + range_.first, range_.count, sample_, plan_.options.lens},
            groups_of(range_.count, CAMERA_RAYS_GROUP), {plan_.traced_pixels.count > 0, plan_.options.lens});
}

void TracePieces::append_traced_pixels(Chain& chain) const {
  chain.run(
      stages::trace_pixels,
      {chain.at(tree_.wide_nodes), chain.at(tree_.wide_counts), chain.at(tree_.nodes),
       chain.at(tree_.triangles), chain.at(plan_.counters), chain.at(tree_.state), chain.at(plan_.film),
       chain.at(plan_.material_index), chain.at(plan_.materials), chain.at(plan_.lighting),
       chain.at(plan_.srgb_thresholds), chain.at(plan_.image), band_first_ + range_.first, range_.count},
      groups_of(range_.count, TRACE_PACKET), {plan_.options.max_turns, plan_.options.directional_light});
}

// Those of instances in one step, and those of pixels.
std::uint64_t TracePieces::append_hits(Chain& chain, std::uint64_t work) {
  if (traces_pixels(plan_.options)) {
    append_traced_pixels(chain);
    range_.next_triangle = std::max(tree_.triangle_count, 1u);
    return range_.count;
  }
  if (!levels_) return append_closest_hits(chain, tree_, plan_, range_, plan_.options, work);
  append_instance_hits(chain, levels_->plan, plan_, levels_->hits.hit_instances, range_.count, plan_.options,
                       range_.first);
  range_.next_triangle = std::max(tree_.triangle_count, 1u);
  return range_.count;
}

// Of instances a triangle and a material each ray.
TracePieces::Surfaces TracePieces::surfaces(const Chain& chain) const {
  const auto materials = chain.at(plan_.materials);
  if (!levels_) return {chain.at(tree_.triangles), chain.at(plan_.material_index), materials};
  return {chain.at(levels_->hits.triangles, range_.first),
          chain.at(levels_->hits.material_index, range_.first), materials};
}

// Of textures a material each ray.
TracePieces::Surfaces TracePieces::textured_surfaces(const Chain& chain) const {
  Surfaces result = surfaces(chain);
  if (plan_.options.textures.textures > 0)
    result = {result.triangles, {}, chain.at(plan_.textures.hit_materials, range_.first)};
  return result;
}

void TracePieces::append_hit_textures(Chain& chain) const {
  if (plan_.options.textures.textures == 0) return;
  const auto [triangles, material_index, materials] = surfaces(chain);
  append_textures(chain, plan_.textures,
                  {chain.at(plan_.film),
                   triangles,
                   material_index,
                   chain.at(plan_.rays, range_.first),
                   chain.at(plan_.hits, range_.first),
                   chain.at(plan_.textures.hit_materials, range_.first),
                   {},
                   range_.count});
}

void TracePieces::append_shade(Chain& chain, Vec3Buffer radiance) const {
  const auto [triangles, material_index, materials] = textured_surfaces(chain);
  chain.run(
      stages::shade,
      {triangles, material_index, materials, chain.at(plan_.lighting), chain.at(plan_.rays, range_.first),
       chain.at(plan_.hits, range_.first), radiance, range_.count, summed_samples()},
      groups_of(range_.count, SHADE_GROUP), {plan_.options.directional_light && !plan_.options.lights.any()});
}

void TracePieces::append_all_lights(Chain& chain, Vec3Buffer radiance) const {
  if (!plan_.options.lights.any()) return;
  const auto [triangles, material_index, materials] = textured_surfaces(chain);
  append_lights(chain, tree_, plan_.lights,
                {triangles, material_index, materials, chain.at(plan_.rays, range_.first),
                 chain.at(plan_.hits, range_.first), radiance, range_.count,
                 address_or_null(chain, plan_.traced_pixels, band_first_ + range_.first),
                 band_first_ + range_.first, sample_, plan_.filter.alpha},
                plan_.options);
}

void TracePieces::append_paths_of(Chain& chain, Vec3Buffer radiance) const {
  const auto [triangles, material_index, materials] = surfaces(chain);
  append_paths(chain, tree_, plan_.paths, plan_.textures,
               {chain.at(plan_.film), triangles, material_index, chain.at(plan_.rays, range_.first),
                chain.at(plan_.hits, range_.first), radiance, chain.at(plan_.lighting),
                address_or_null(chain, plan_.traced_pixels, band_first_ + range_.first),
                band_first_ + range_.first, range_.count, summed_samples(), sample_, plan_.filter.alpha},
               plan_.options);
}

void TracePieces::append_show(Chain& chain, Vec3Buffer radiance) const {
  const ShowSlots& show = plan_.show;
  const PlacedHitSlots placed = levels_ ? levels_->hits : PlacedHitSlots{};
  chain.run(
      stages::show,
      {surfaces(chain).triangles, chain.at(plan_.hits, range_.first),
       address_or_null(chain, plan_.ray_steps, range_.first), address_or_null(chain, show.primitive_values),
       address_or_null(chain, placed.hit_instances, range_.first),
       address_or_null(chain, placed.primitives, range_.first), chain.at(show.colour_map),
       chain.at(show.scale), chain.at(show.range), radiance, range_.count, summed_samples(),
       plan_.options.show, 0},
      groups_of(range_.count, SHOW_GROUP), {plan_.options.show});
}

void TracePieces::append_pixels(Chain& chain) const {
  const auto [triangles, material_index, materials] = surfaces(chain);
  chain.run(stages::shade_pixels,
            {chain.at(plan_.film), triangles, material_index, materials, chain.at(plan_.lighting),
             chain.at(plan_.hits, range_.first), chain.at(plan_.srgb_thresholds), chain.at(plan_.image),
             band_first_ + range_.first, range_.count},
            groups_of(range_.count, SHADE_PIXELS_TILE), {plan_.options.directional_light});
}

void TracePieces::append_radiance(Chain& chain) const {
  const TraceOptions& options = plan_.options;
  const std::uint32_t first_pixel = band_first_ + range_.first;
  const auto sum = chain.at(plan_.radiance, keeps_whole_radiance(options) ? first_pixel : range_.first);
  const auto radiance = options.keep_noise ? chain.at(plan_.noise.sample_radiance, range_.first) : sum;
  if (options.show != SHOW_COLOR) {
    append_show(chain, radiance);
  } else {
    if (options.paths.any()) {
      append_paths_of(chain, radiance);
    } else {
      append_hit_textures(chain);
      append_shade(chain, radiance);
      append_all_lights(chain, radiance);
    }
  }
  if (options.keep_noise)
    append_sample(chain, plan_.noise, plan_.radiance,
                  {range_.first, range_.count, sample_, first_pixel, plan_.traced_pixels});
  if (options.resolves && sample_ + 1 == options.samples)
    append_resolve(chain, plan_, sum, first_pixel, range_.count);
}

void TracePieces::close_range(Chain& chain) {
  if (levels_) append_placed_hits(chain, levels_->plan, plan_, levels_->hits, range_.first, range_.count);
  if (keeps_radiance(plan_.options))
    append_radiance(chain);
  else if (!traces_pixels(plan_.options))
    append_pixels(chain);
  range_ = {range_.first + range_.count, 0, 0};
  if (range_.first < band_rays()) return;
  range_ = {};
  if (++sample_ < plan_.options.samples) return;
  sample_ = plan_.options.first_sample;
  band_first_ += band_rays();
}

std::uint64_t TracePieces::append(Chain& chain, std::uint64_t work) {
  if (!cleared_) chain.clear(plan_.counters);
  if (!cleared_) chain.clear(plan_.show.range);
  if (!cleared_) chain.clear(plan_.lights.counters);
  if (!cleared_) chain.clear(plan_.lights.occlusion_counters);
  if (!cleared_) chain.clear(plan_.paths.bounce_counters);
  if (!cleared_) chain.clear(plan_.paths.light_counters);
  if (!cleared_) chain.clear(plan_.paths.lobe_counters);
  cleared_ = true;
  std::uint64_t appended = 0;
  while (!done() && has_room(tree_, plan_.options, appended, work)) {
    if (range_.count == 0) open_range(chain, work - appended);
    appended += append_hits(chain, work - appended);
    if (!has_closest_hits(tree_, range_, plan_.options)) break;
    close_range(chain);
  }
  return appended;
}

}  // namespace coppice
