#pragma once

#include "pipeline/instances.h"
#include "pipeline/trace_any.h"
#include "pipeline/trace_plan.h"

namespace coppice {

// A trace cut into pieces, each for a submit of its own, so that no submit takes long. However it is cut,
// every ray and every pixel goes through the same steps in the same order: the bits are the same.
//
// Work is counted in rays, by brute force in tests of triangles.

// Rays that a range of so much work may have: a multiple of RANGE_RAYS, at least one of them.
std::uint32_t range_rays(const TreeSlots& tree, const TraceOptions& options, std::uint64_t work);

// Work of the closest hits of so many rays.
std::uint64_t work_of(const TreeSlots& tree, const TraceOptions& options, std::uint64_t rays);

// Of the first submit, when nothing is known of the device's speed.
inline std::uint64_t first_work(const TraceOptions& options) {
  return options.walk == Walk::brute_force ? 1u << 20 : 4096;
}

// The closest hits of the first rays of their slots.
class HitPieces {
 public:
  HitPieces(const TreeSlots& tree, const RaySlots& slots, std::uint32_t ray_count,
            const TraceOptions& options)
      : tree_(tree), slots_(slots), options_(options), ray_count_(ray_count) {}

  bool done() const { return range_.count == 0 && range_.first == ray_count_; }
  std::uint64_t work() const { return work_of(tree_, options_, ray_count_); }

  // Appends the next piece: at least one step, otherwise at most `work`. Returns its work.
  std::uint64_t append(Chain& chain, std::uint64_t work);

 private:
  TreeSlots tree_;
  RaySlots slots_;
  TraceOptions options_;
  std::uint32_t ray_count_;
  RayRange range_;  // no rays: the next one is yet to be opened
};

// The any hits of the first rays of their slots, which have no count on the device.
class AnyHitPieces {
 public:
  AnyHitPieces(const TreeSlots& tree, const AnyHitSlots& slots, std::uint32_t ray_count,
               const TraceOptions& options)
      : tree_(tree), slots_(slots), options_(options), ray_count_(ray_count) {}

  bool done() const { return ray_count_ == 0; }

  // As HitPieces::append.
  std::uint64_t append(Chain& chain, std::uint64_t work);

 private:
  TreeSlots tree_;
  AnyHitSlots slots_;  // of the rays that are left
  TraceOptions options_;
  std::uint32_t ray_count_;
};

// Instances, and what is shaded of their hits.
struct TwoLevels {
  InstancePlan plan;
  PlacedHitSlots hits;  // of a band's rays
};

// A picture: camera rays, closest hits, shading or what is shown in its place, sRGB.
class TracePieces {
 public:
  // `first_pixel`: those before it, in the order of FILM_STRIP, are left out; a multiple of RANGE_RAYS.
  // `levels`: of instances, whose tree `tree` then is; null: of triangles.
  TracePieces(const TreeSlots& tree, const TracePlan& plan, std::uint32_t first_pixel = 0,
              const TwoLevels* levels = nullptr)
      : tree_(tree),
        plan_(plan),
        levels_(levels),
        cleared_(plan.options.first_sample > 0),
        band_first_(first_pixel),
        sample_(plan.options.first_sample) {}

  bool done() const { return band_first_ >= traced_pixels(); }
  std::uint64_t work() const {
    return work_of(tree_, plan_.options,
                   std::uint64_t{traced_pixels()} * (plan_.options.samples - plan_.options.first_sample));
  }

  // As HitPieces::append.
  std::uint64_t append(Chain& chain, std::uint64_t work);

 private:
  std::uint32_t band_rays() const;
  std::uint32_t traced_pixels() const {
    return static_cast<std::uint32_t>(plan_.traced_pixels.count > 0 ? plan_.traced_pixels.count
                                                                    : plan_.image.count);
  }
  // Those that are in the radiance that this one is added to: none where each is shaded by itself.
  std::uint32_t summed_samples() const { return plan_.options.keep_noise ? 0 : sample_; }
  std::uint64_t append_hits(Chain& chain, std::uint64_t work);
  void open_range(Chain& chain, std::uint64_t work);
  void close_range(Chain& chain);
  // What hits of this range name.
  struct Surfaces {
    TriangleBuffer triangles;
    UintBuffer material_index;
    SurfaceMaterialBuffer materials;
  };
  Surfaces surfaces(const Chain& chain) const;
  Surfaces textured_surfaces(const Chain& chain) const;
  void append_pixels(Chain& chain) const;
  void append_traced_pixels(Chain& chain) const;
  void append_hit_textures(Chain& chain) const;
  void append_paths_of(Chain& chain, Vec3Buffer radiance) const;
  void append_radiance(Chain& chain) const;
  void append_shade(Chain& chain, Vec3Buffer radiance) const;
  void append_all_lights(Chain& chain, Vec3Buffer radiance) const;
  void append_show(Chain& chain, Vec3Buffer radiance) const;

  TreeSlots tree_;
  TracePlan plan_;
  const TwoLevels* levels_;   // outlive it
  bool cleared_;              // counts, which go on from the samples before
  std::uint32_t band_first_;  // pixel; a band goes through all its samples before the next one
  std::uint32_t sample_;
  RayRange range_;  // of the band; no rays: the next one is yet to be opened
};

}  // namespace coppice
