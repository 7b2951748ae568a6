// Paths of light: surfaces that reflect and transmit, and the directions in which paths go on.
#ifndef COPPICE_INTERFACE_PATHS_H
#define COPPICE_INTERFACE_PATHS_H
#include "circle.h"
#include "environment.h"
#include "lights.h"
INTERFACE_BEGIN

// What a surface does with light at one point. Values out of their range count as its nearest end.
struct SurfacePoint {
  vec3 normal;         // unit, on the side of the view
  float roughness;     // 0 to 1; alpha of GGX is its square
  vec3 diffuse;        // albedo, 0 to 1
  float ior_ratio;     // index of refraction on the side of the view by that of the other side, 1/16 to 16
  vec3 specular;       // reflectance at normal incidence, 0 to 1; black: nothing is reflected but diffusely
  float transmission;  // 0 to 1: the part of the light that is not reflected which goes through
};

INTERFACE_BUFFER(SurfacePointBuffer, SurfacePoint, 16)

// Which lobe a sampled direction is of.
const uint BSDF_NONE = 0u;  // no direction: the path ends
const uint BSDF_DIFFUSE = 1u;
const uint BSDF_GLOSSY = 2u;
const uint BSDF_MIRROR = 4u;
const uint BSDF_TRANSMISSION = 8u;

// A direction in which a path goes on.
struct BsdfSample {
  vec3 light;   // unit, away from the surface
  float pdf;    // by solid angle; 0: no light source that is sampled could have been met, see lib/bsdf.glsl
  vec3 weight;  // BSDF times cosine by the density, that of the choice of the lobe included; not negative
  uint flags;   // BSDF_
};

// BSDF times cosine towards a light, of the lobes that have a density.
struct BsdfTerms {
  vec3 diffuse;
  float pdf;  // by solid angle, of directions as they are sampled
  vec3 glossy;
  float padding;  // 0
};

const float BSDF_MIRROR_ALPHA = 0.001;                  // below it a mirror
const float BSDF_MIN_COSINE = 9.5367431640625e-07;      // 2^-20: nothing is seen at an angle that is flatter
const float BSDF_LEAST_PICK = 0.125;                    // of a rough lobe before shares become probabilities
const float BSDF_LEAST_SHARES = 9.094947017729282e-13;  // 2^-40: darker surfaces end a path
const float ONE_BY_PI = 0.318309886;

// --- Stages of paths. Laine, Karras and Aila 2013, "Megakernels Considered Harmful: Wavefront Path Tracing
// on GPUs": a queue of rays, each with its path; all stages go through the queue in its order.

const uint PATH_GROUP = 64;
const uint MAX_BOUNCES = 64;

const uint PATH_SEES_AMBIENT = 1u;  // of a diffuse bounce: what hits nothing meets the ambient light, not the
                                    // sky; with an environment, which is what all meet, of no meaning

// Of the ray of the same index in the queue.
struct Path {
  vec3 throughput;
  uint pixel;  // ray of the band: where its radiance goes; each has at most one path
  float pdf;   // of the ray's direction by solid angle; 0: no sampled light could have been it
  uint flags;  // PATH_
  uint seed;   // of the pixel, for sample_2d
  uint padding;
};

// What a material has beside SurfaceMaterial, which on this route has emission as `ambient`, and as `diffuse`
// the base colour.
struct PathMaterial {
  vec3 specular;  // reflectance at normal incidence where it is no metal
  float roughness;
  vec3 filter_colour;  // of what is transmitted
  float ior;           // of the side that the normal points away from
  float metallic;      // part of the base colour that is reflectance, not albedo
  float transmission;
  uint padding0, padding1;
};

// Sources of light, to choose one by a number in [0, 2^24): the first whose `end` is above it.
struct LightChoice {
  uint source;        // triangle, LIGHT_CHOICE_LISTED and an index of lights, or LIGHT_CHOICE_ENVIRONMENT
  float probability;  // exactly its share of 2^24; positive
  uint end;
  uint shadows;   // 0: nothing is in its way
  vec3 emission;  // of a triangle
  uint padding;
};

const uint LIGHT_CHOICE_LISTED = 0x80000000u;
const uint LIGHT_CHOICE_ENVIRONMENT = 0xffffffffu;
const uint LIGHT_CHOICE_RANGE = 0x1000000u;

// Rays by which paths have gone on, by the lobe: 64-bit sums, low word first.
struct PathCounters {
  uvec2 diffuse, reflected, transmitted;
  uint padding0, padding1;
};

INTERFACE_BUFFER(PathBuffer, Path, 16)
INTERFACE_BUFFER(PathCountersBuffer, PathCounters, 8)
INTERFACE_BUFFER(PathMaterialBuffer, PathMaterial, 16)
INTERFACE_BUFFER(LightChoiceBuffer, LightChoice, 16)

// A path for each camera ray.
struct PathStartArgs {
  PathBuffer paths;          // out, ray_count
  UintBuffer count;          // out, a word: ray_count
  Vec3Buffer radiance;       // ray_count; set to 0 where sample_index is 0
  READS(UintBuffer) pixels;  // as in CameraRaysArgs
  uint first_ray;            // as there
  uint ray_count;
  uint sample_index;
  uint padding;
};

// Of each hit what its surface does; what it emits, and what a miss meets, is added to the radiance of the
// pixel, weighted against that the light could have been sampled (Veach and Guibas 1995, power heuristic).
struct PathSurfacesArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;  // as in ShadeArgs
  READS(SurfaceMaterialBuffer) materials;
  READS(UintBuffer) path_index;  // one a triangle, into path_materials
  READS(PathMaterialBuffer) path_materials;
  READS(FloatBuffer)
  emitter_probability;  // one a triangle, that of its LightChoice or 0; null: none is chosen
  READS(LightingBuffer) lighting;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(PathBuffer) paths;
  SurfacePointBuffer surfaces;  // out, one a ray; of a miss not written
  Vec3Buffer radiance;
  READS(UintBuffer) count_at;  // as in TraceClosestArgs
  READS(SurroundingBuffer) surroundings;
  uint ray_count;
  uint flags;  // PATH_BOUNCES_LIGHT, PATH_HAS_ENVIRONMENT
};

const uint PATH_BOUNCES_LIGHT =
    1u;  // ambient light is what diffuse bounces meet, else it reaches all surfaces
const uint PATH_HAS_ENVIRONMENT = 2u;  // rays that hit nothing meet the map of the surroundings

struct PathSurfacesConstants {
  uint bounces_light;  // 1: the flag is set, as the next one
  uint has_environment;
};

// Of each hit a light, chosen and sampled, and what reaches the pixel from it unless something is in the way.
struct PathLightsArgs {
  READS(TriangleBuffer) triangles;
  READS(LightSourceBuffer) lights;
  READS(LightChoiceBuffer) choices;  // choice_count; the last `end` is LIGHT_CHOICE_RANGE
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(PathBuffer) paths;
  READS(SurfacePointBuffer) surfaces;
  READS(SurroundingBuffer) surroundings;  // read where it is a choice
  RayBuffer light_rays;                   // out, of marked ones
  Vec3Buffer light_radiance;              // out, of marked ones
  UintBuffer marks;                       // out, one a ray: 1 where something may be in the way, else 0
  Vec3Buffer radiance;                    // to which is added what nothing can be in the way of
  READS(UintBuffer) count_at;
  uint ray_count;
  uint choice_count;  // positive
  uint sample_index;
  uint bounce;
  uint lobes;    // PATH_LOBE_, PATH_LAST_BOUNCE
  uint has_fog;  // 1: light is dimmed by the fog of the surroundings, see interface/fog.h
};

struct PathBsdfConstants {
  uint diffuse_lobe;  // see lib/bsdf.glsl
  uint reflects;
  uint transmits;
};

struct PathLightsConstants {
  uint diffuse_lobe;  // as in PathBsdfConstants
  uint reflects;
  uint transmits;
  uint has_environment;  // 1: it is a choice
  uint has_fog;          // as in PathLightsArgs
};

// Adds the radiance of marked lights whose ray has hit nothing.
struct PathLightAddArgs {
  READS(PathBuffer) paths;
  READS(UintBuffer) marks;
  READS(UintBuffer) places;
  READS(UintBuffer) any_hits;  // one a light ray
  READS(Vec3Buffer) light_radiance;
  Vec3Buffer radiance;
  READS(UintBuffer) count_at;
  uint ray_count;
  uint padding;
};

// Of each hit the ray by which its path goes on, or none.
struct PathBounceArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) path_index;
  READS(PathMaterialBuffer) path_materials;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(PathBuffer) paths;
  READS(SurfacePointBuffer) surfaces;
  RayBuffer bounced_rays;       // out, of marked ones
  PathBuffer bounced_paths;     // out, of marked ones
  UintBuffer marks;             // out, one a ray
  PathCountersBuffer counters;  // added to
  READS(UintBuffer) count_at;
  uint ray_count;
  uint sample_index;
  uint bounce;
  uint lobes;  // PATH_LOBE_
};

// Marked rays, one behind the other: the next queue.
struct PathQueueArgs {
  READS(UintBuffer) marks;
  READS(UintBuffer) places;  // the exclusive prefix sums of the marks
  READS(RayBuffer) marked_rays;
  READS(PathBuffer) marked_paths;  // null: of light rays, as the two that follow
  PathBuffer queued_paths;         // out
  HitBuffer queued_hits;           // out, misses
  RayBuffer queued_rays;           // out
  UintBuffer queued_count;         // out, a word
  uint ray_count;                  // positive
  uint padding;
};

// Which lobes of surfaces there are on the way: see lib/bsdf.glsl.
const uint PATH_LOBE_DIFFUSE = 1u;
const uint PATH_LOBE_REFLECTS = 2u;
const uint PATH_LOBE_TRANSMITS = 4u;
const uint PATH_LAST_BOUNCE = 8u;  // no path goes on to meet what lights are sampled: they count in full

// Where numbers of sample_2d come from: a dimension each use and bounce.
const uint PATH_DIMENSIONS = 5u;  // of a bounce
const uint PATH_PICKS_LIGHT = 0u;
const uint PATH_PLACES_LIGHT = 1u;
const uint PATH_PICKS_LOBE = 2u;
const uint PATH_TURNS = 3u;
const uint PATH_ENDS = 4u;
// Of the dimensions behind those of all bounces, one a bounce: where in a texel of the environment.
const uint PATH_PLACES_IN_TEXEL = (MAX_BOUNCES + 1u) * PATH_DIMENSIONS;

const uint PATH_SURE_BOUNCES = 2u;  // then a path goes on by chance, in proportion to its throughput
const float PATH_MOST_SURE = 0.95;

INTERFACE_END
#endif
