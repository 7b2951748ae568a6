// Lights beside the plain one of Lighting, and the shadows that they cast.
#ifndef COPPICE_INTERFACE_LIGHTS_H
#define COPPICE_INTERFACE_LIGHTS_H
#include "copy.h"
#include "shade.h"
INTERFACE_BEGIN

const uint SHADOW_MARKS_GROUP = 64;
const uint SHADOW_RAYS_GROUP = 64;
const uint SHADE_LIGHTS_GROUP = 64;

const uint MAX_LIGHTS = 64;  // of a scene: a picture has a chain of steps for each that casts shadows

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;

struct LightSource {
  vec3 place;  // directional: unit, towards the light; of a point where it is
  uint kind;   // LIGHT_
  vec3 radiance;
  float distance;  // of a point: where it lights as a directional light of that radiance
};

INTERFACE_BUFFER(LightSourceBuffer, LightSource, 16)

// Of a light that casts shadows: which hits need a shadow ray. Those whose surface shows the camera the side
// that the light is on, and reflects some of the light.
struct ShadowMarksArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;  // as in ShadeArgs
  READS(SurfaceMaterialBuffer) materials;
  READS(LightSourceBuffer) lights;
  READS(RayBuffer) rays;  // ray_count
  READS(HitBuffer) hits;  // ray_count
  UintBuffer marks;       // out, one a ray: 1 or 0
  uint light;
  uint ray_count;
};

// The shadow rays of marked hits, one behind the other in the order of the hits. They end at the light.
struct ShadowRaysArgs {
  READS(TriangleBuffer) triangles;
  READS(LightSourceBuffer) lights;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(UintBuffer) marks;
  READS(UintBuffer) places;  // the exclusive prefix sums of the marks
  RayBuffer shadow_rays;     // out, as many as there are marks
  UintBuffer shadow_count;   // out, a word
  uint light;
  uint ray_count;  // positive
};

// Adds what surfaces reflect of some lights that follow each other, `light_count` of them. With `marks` it is
// one light that casts shadows: it lights marked hits whose shadow ray has hit nothing.
struct ShadeLightsArgs {
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;        // as in ShadeArgs
  READS(SurfaceMaterialBuffer) materials;  // diffuse: the colour alone
  READS(LightSourceBuffer) lights;
  READS(RayBuffer) rays;
  READS(HitBuffer) hits;
  READS(UintBuffer) marks;     // null: of lights without shadows, as the two that follow
  READS(UintBuffer) places;    // of marked hits: which shadow ray
  READS(UintBuffer) any_hits;  // one a shadow ray
  Vec3Buffer radiance;         // ray_count; added to
  uint first_light;
  uint light_count;
  uint ray_count;
  uint padding;
};

struct ShadeLightsConstants {
  uint shadows;  // 0 without marks
  uint points;   // 0 where no light is a point
};

INTERFACE_END
#endif
