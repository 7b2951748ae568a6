#pragma once

#include <cstdint>

#include "interface/fog.h"
#include "pipeline/alpha.h"
#include "pipeline/lights.h"
#include "pipeline/textures.h"
#include "stages/run_counts.h"

namespace coppice {

// What paths of light a picture follows.
struct PathCounts {
  bool follows = false;                // none: the camera's rays are shaded where they end
  std::uint32_t bounces = 0;           // at most
  std::uint32_t choices = 0;           // lights to choose from
  std::uint32_t lights = 0;            // of those that are listed
  bool emitters = false;               // triangles are among them
  bool shadows = false;                // something may be in the way of some
  std::uint32_t lobes = 0;             // PATH_LOBE_
  bool bounces_light = false;          // ambient light is met by diffuse bounces alone
  std::uint32_t environment_side = 0;  // of the map that rays meet which hit nothing; 0: there is none
  bool fog = false;                    // it is in the way of light

  bool operator==(const PathCounts&) const = default;
  bool any() const { return follows; }
};

// What paths keep, for the rays of a band; all empty where there are none.
struct PathSlots {
  Slot<SurfaceMaterial> materials;          // in: emission and base colour
  Slot<PathMaterial> path_materials;        // in
  Slot<Surrounding> surroundings;           // in
  Slot<LightSource> lights;                 // in
  Slot<LightChoice> choices;                // in
  Slot<float> emitter_probability;          // in, one a triangle
  Slot<Path> paths, bounced_paths;          // the queue, and what is marked for the next one
  Slot<Ray> rays, light_rays, marked_rays;  // of the queue after the first bounce, and of what is marked
  Slot<Hit> hits;
  Slot<SurfacePoint> surfaces;
  Slot<vec3> light_radiance;
  Slot<uvec4> marks, places;
  Slot<uint> scan_status, queue_count, light_count, any_hits;
  Slot<TraceCounters> bounce_counters, light_counters;
  Slot<PathCounters> lobe_counters;
};

// Entries of the surroundings.
constexpr std::uint64_t surrounding_count(const PathCounts& counts) {
  const std::uint64_t side = counts.environment_side;
  return 1 + side * (side + 1) + (counts.fog ? FOG_ENTRIES : 0);
}

LobeCounts counts_of(const PathCounters& counters);

// Throws LayoutError if a slot does not fit a block.
PathSlots plan_paths(Layout& layout, const PathCounts& counts, std::uint32_t triangle_count,
                     std::uint32_t material_count, std::uint32_t band_rays);

// Camera rays of a range and what they have hit.
struct CameraPaths {
  FilmBuffer film;
  TriangleBuffer triangles;
  UintBuffer path_index;  // material of each triangle
  RayBuffer rays;
  HitBuffer hits;
  Vec3Buffer radiance;
  LightingBuffer lighting;
  UintBuffer pixels;  // as in CameraRaysArgs
  std::uint32_t first_ray, count;
  std::uint32_t summed_samples;  // 0: radiance begins at 0
  std::uint32_t sample_index;
  AlphaSlots alpha{};  // of the triangles that rays may go past
};

// All radiance that reaches these pixels by paths. Throws std::invalid_argument by brute force.
void append_paths(Chain& chain, const TreeSlots& tree, const PathSlots& slots, const TextureSlots& textures,
                  const CameraPaths& camera, const TraceOptions& options);

}  // namespace coppice
