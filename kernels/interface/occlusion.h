// Ambient light, and what stands in its way.
#ifndef COPPICE_INTERFACE_OCCLUSION_H
#define COPPICE_INTERFACE_OCCLUSION_H
#include "shade.h"
INTERFACE_BEGIN

const uint OCCLUSION_MARKS_GROUP = 64;
const uint OCCLUSION_RAYS_GROUP = 64;
const uint SHADE_AMBIENT_GROUP = 64;

// Light that comes alike from all sides.
struct AmbientLight {
  vec3 radiance;   // what a white surface reflects of it
  float distance;  // no farther off does anything block it
};

INTERFACE_BUFFER(AmbientLightBuffer, AmbientLight, 16)

// Which hits need a ray: those whose surface reflects some of the light.
struct OcclusionMarksArgs {
  READS(UintBuffer) material_index;        // as in ShadeArgs
  READS(SurfaceMaterialBuffer) materials;  // diffuse: the colour alone
  READS(AmbientLightBuffer) ambient;       // one
  READS(HitBuffer) hits;                   // ray_count
  UintBuffer marks;                        // out, one a ray: 1 or 0
  uint ray_count;
  uint padding;
};

// Of each marked hit a ray into the hemisphere on the side of the camera, by the cosine to the normal; one
// behind the other in the order of the hits.
struct OcclusionRaysArgs {
  READS(TriangleBuffer) triangles;
  READS(AmbientLightBuffer) ambient;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(UintBuffer) marks;
  READS(UintBuffer) places;  // the exclusive prefix sums of the marks
  READS(UintBuffer) pixels;  // as in CameraRaysArgs, as is first_ray
  RayBuffer occlusion_rays;  // out, as many as there are marks; of unit length, they end at the distance
  UintBuffer ray_counter;    // out, a word: their number
  uint first_ray;
  uint ray_count;  // positive
  uint sample_index;
  uint padding;
};

// Adds what surfaces reflect of the light where the ray of a marked hit has hit nothing.
struct ShadeAmbientArgs {
  READS(UintBuffer) material_index;
  READS(SurfaceMaterialBuffer) materials;
  READS(AmbientLightBuffer) ambient;
  READS(HitBuffer) hits;
  READS(UintBuffer) marks;
  READS(UintBuffer) places;
  READS(UintBuffer) any_hits;  // one an occlusion ray
  Vec3Buffer radiance;         // ray_count; added to
  uint ray_count;
  uint padding;
};

INTERFACE_END
#endif
