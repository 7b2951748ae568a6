// The pixel of a camera ray in a scene of ambient colours and one directional light.
// Needs `args` as in ShadePixelsArgs and the constant SHADE_DIRECTIONAL_LIGHT.
#include "scene_light.glsl"
#include "srgb_code.glsl"

vec3 surface(uint triangle, vec3 direction, Lighting lighting) {
  SurfaceMaterial material = args.materials.at[args.material_index.at[triangle]];
  if (SHADE_DIRECTIONAL_LIGHT == 0u) return material.ambient;
  return lit(material, args.triangles.at[triangle], direction, lighting);
}

// RGBA8. `triangle`: NO_TRIANGLE for the sky.
uint plain_pixel(uint triangle, vec3 direction, Lighting lighting) {
  vec3 colour = triangle == NO_TRIANGLE ? sky(direction, lighting) : surface(triangle, direction, lighting);
  return rgba8(colour, args.srgb_thresholds);
}
