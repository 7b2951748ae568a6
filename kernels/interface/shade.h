// What is done with the hits of pictures: materials and light, radiance, and what a display shows of it.
#ifndef COPPICE_INTERFACE_SHADE_H
#define COPPICE_INTERFACE_SHADE_H
#include "trace.h"
INTERFACE_BEGIN

const uint SHADE_GROUP = 64;
const uint SHADE_PIXELS_PER_INVOCATION = 8;
const uint SHADE_PIXELS_TILE = SHADE_GROUP * SHADE_PIXELS_PER_INVOCATION;
const uint RESOLVE_GROUP = 64;

// How radiance becomes what a display shows.
const uint TONE_NONE = 0;         // as it is
const uint TONE_REINHARD = 1;     // Reinhard et al. 2002, on luminance, with TONE_WHITE
const uint TONE_ACES = 2;         // Hill's fit of the transforms of ACES
const float TONE_WHITE = 4.0;     // the luminance that becomes 1
const float TONE_MOST = 65536.0;  // what channels above it count as

struct SurfaceMaterial {
  vec3 ambient;  // emission and ambient light, already multiplied
  vec3 diffuse;  // diffuse colour times the light's radiance
};

// The directional light and the background, linear RGB.
struct Lighting {
  vec3 light_direction;  // unit, towards the light
  float padding0;
  vec3 sky_horizon;
  float padding1;
  vec3 sky_zenith;
  float padding2;
};

INTERFACE_BUFFER(SurfaceMaterialBuffer, SurfaceMaterial, 8)
INTERFACE_BUFFER(LightingBuffer, Lighting, 16)

struct ShadeArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;  // one a triangle; null: `materials` are one a ray
  READS(SurfaceMaterialBuffer) materials;
  READS(LightingBuffer) lighting;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  Vec3Buffer radiance;  // ray_count; summed over the samples
  uint ray_count;
  uint sample_index;
};

// Of pictures of one sample a pixel.
struct ShadePixelsArgs {
  READS(FilmBuffer) film;
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;  // one a triangle
  READS(SurfaceMaterialBuffer) materials;
  READS(LightingBuffer) lighting;
  READS(HitBuffer) hits;              // ray_count
  READS(UintBuffer) srgb_thresholds;  // as in ResolveArgs
  UintBuffer image;                   // as in ResolveArgs
  uint first_ray;                     // of the picture
  uint ray_count;
};

// The same pictures through a wide tree, watertight and robust, with no ray and no hit kept.
struct TracePixelsArgs {
  READS(WideNodeBuffer) wide_nodes;  // these three as in TraceWideArgs
  READS(WideCountsBuffer) wide_counts;
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(FilmBuffer) film;  // this and what follows as in ShadePixelsArgs
  READS(UintBuffer) material_index;
  READS(SurfaceMaterialBuffer) materials;
  READS(LightingBuffer) lighting;
  READS(UintBuffer) srgb_thresholds;
  UintBuffer image;
  uint first_ray;
  uint ray_count;
};

struct ResolveArgs {
  READS(FilmBuffer) film;
  READS(Vec3Buffer) radiance;         // one a ray
  READS(UintBuffer) sample_counts;    // one a ray; null: all have as many as the film says
  READS(UintBuffer) srgb_thresholds;  // 256 floats as bits: the least linear value of each 8-bit sRGB code
  UintBuffer image;                   // RGBA8, red in the low byte, rows top to bottom
  uint first_ray;
  uint ray_count;
  uint exposure;    // the bits of a float, by which radiance is multiplied
  uint tone_curve;  // TONE_
};

// Specialization constants, as in trace.h.
struct TracePixelsConstants {
  uint max_turns;
  uint directional_light;  // as in ShadeConstants
};

struct ResolveConstants {
  uint has_counts;  // 0 where there are no sample_counts
  uint tone_curve;
  uint is_exposed;  // 0 where the exposure is 1
};

struct ShadeConstants {
  uint directional_light;  // 0 where the scene has none
};

INTERFACE_END
#endif
