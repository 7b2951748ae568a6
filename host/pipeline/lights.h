#pragma once

#include <cstdint>

#include "interface/lights.h"
#include "interface/occlusion.h"
#include "pipeline/alpha.h"
#include "pipeline/build_plan.h"

namespace coppice {

// Lights that shading goes over one by one, in the place of the plain one of Lighting. The last of them cast
// shadows.
struct LightCounts {
  std::uint32_t lights = 0;  // none: the plain one
  std::uint32_t shadows = 0;
  bool points = false;     // whether some are points
  bool occlusion = false;  // whether ambient light is one more, which comes from all sides

  bool any() const { return lights > 0 || occlusion; }

  bool operator==(const LightCounts&) const = default;
};

// What lights and shadows keep, for a band of rays; all empty where there are no lights. One light after the
// other takes the same queue of shadow rays, and so do the occlusion rays of ambient light.
struct LightSlots {
  Slot<LightSource> sources;   // in
  Slot<AmbientLight> ambient;  // in, where there is occlusion
  // Where some cast shadows, or there is occlusion:
  Slot<uvec4> marks, places;  // a word a ray
  Slot<uint> scan_status;
  Slot<Ray> shadow_rays;  // compacted
  Slot<uint> shadow_count;
  Slot<uint> any_hits;
  Slot<TraceCounters> counters;            // of shadow rays alone
  Slot<TraceCounters> occlusion_counters;  // of occlusion rays alone
};

// Throws LayoutError if a slot does not fit a block, std::invalid_argument for more than MAX_LIGHTS.
LightSlots plan_lights(Layout& layout, const LightCounts& counts, std::uint32_t band_rays);

struct TraceOptions;

// Rays of a picture and what they have hit.
struct LitRays {
  TriangleBuffer triangles;
  UintBuffer material_index;
  SurfaceMaterialBuffer materials;
  RayBuffer rays;
  HitBuffer hits;
  Vec3Buffer radiance;
  std::uint32_t count;
  UintBuffer pixels;  // as in CameraRaysArgs, as is first_ray
  std::uint32_t first_ray;
  std::uint32_t sample_index;
  AlphaSlots alpha{};  // of the triangles that may be in the way
};

// Adds to the radiance what the surfaces reflect of all lights: those without shadows in one step; for each
// other one marks, their prefix sums, shadow rays, any hits through the tree, shading; and the same of
// ambient light. Throws std::invalid_argument for shadows or occlusion by brute force.
void append_lights(Chain& chain, const TreeSlots& tree, const LightSlots& slots, const LitRays& rays,
                   const TraceOptions& options);

}  // namespace coppice
