// A point of a surface and a light.
#include "hit_point.glsl"

// Not of unit length.
vec3 towards(LightSource light, vec3 point) {
  if (light.kind == LIGHT_DIRECTIONAL) return light.place;
  precise vec3 direction = light.place - point;
  return direction;
}
