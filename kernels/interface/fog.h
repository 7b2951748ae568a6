// Fog: a medium of the same density everywhere in a box, which scatters light and absorbs it.
#ifndef COPPICE_INTERFACE_FOG_H
#define COPPICE_INTERFACE_FOG_H
#include "paths.h"
INTERFACE_BEGIN

// Where there is fog its numbers are behind the map in the array of Surrounding, from 1 + side * (side + 1)
// on:
//   radiance: least corner of the box; end: bits of the density, extinction along a unit of length; positive
//   radiance: greatest corner; end: bits of the mean cosine of the angle of scattering, -0.95 to 0.95
//   radiance: albedo, the part of what is taken from a ray that is scattered, 0 to 1; end: 0
const uint FOG_ENTRIES = 3u;

const float ONE_BY_4PI = 0.0795774715;

// Of each path of the queue the way of its ray to what it has hit. The throughput becomes what the fog lets
// through; ambient light that the fog scatters, which reaches it as it does surfaces, is added to the
// radiance; and of a point of the way, the likelier the more of what is scattered there comes through, a
// light is sampled, as of surfaces in PathLightsArgs. So light is scattered once on its way between two
// surfaces (single scattering).
struct PathFogArgs {
  READS(TriangleBuffer) triangles;
  READS(LightSourceBuffer) lights;
  READS(LightChoiceBuffer) choices;
  READS(SurroundingBuffer) surroundings;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  PathBuffer paths;
  RayBuffer light_rays;       // out, of marked ones
  Vec3Buffer light_radiance;  // out, of marked ones
  UintBuffer marks;           // out, one a ray: 1 where something may be in the way of the light, else 0
  Vec3Buffer radiance;
  READS(UintBuffer) count_at;
  uint ray_count;
  uint choice_count;  // 0: there are no lights
  uint sample_index;
  uint bounce;
  uint bounces_light;  // as in PathSurfacesArgs: ambient light is not scattered then
  uint padding;
};

struct PathFogConstants {
  uint has_environment;  // as in PathLightsConstants
};

// Dimensions of sample_2d behind those of all else on a path, so many each bounce.
const uint PATH_FOG_FIRST = PATH_PLACES_IN_TEXEL + MAX_BOUNCES + 1u;
const uint PATH_FOG_DIMENSIONS = 4u;
const uint PATH_FOG_DEPTH = 0u;
const uint PATH_FOG_PICKS_LIGHT = 1u;
const uint PATH_FOG_PLACES_LIGHT = 2u;
const uint PATH_FOG_PLACES_IN_TEXEL = 3u;

INTERFACE_END
#endif
