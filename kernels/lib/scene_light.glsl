// What a ray that hits nothing sees, and one that hits a surface: ambient colour plus one directional light on the side
// that faces the ray.
#include "lib/exact_vector.glsl"

vec3 sky(vec3 direction, Lighting lighting) {
  precise float height = max(unit(direction).y, 0.0);
  precise vec3 colour = lighting.sky_horizon + (lighting.sky_zenith - lighting.sky_horizon) * height;
  return colour;
}

vec3 lit(SurfaceMaterial material, Triangle triangle, vec3 direction, Lighting lighting) {
  vec3 normal = normal_of(triangle);
  float side = exact_dot(normal, direction) > 0.0 ? -1.0 : 1.0;
  float cosine = max(exact_dot(normal, lighting.light_direction) * side, 0.0);
  precise vec3 colour = material.ambient + material.diffuse * cosine;
  return colour;
}
