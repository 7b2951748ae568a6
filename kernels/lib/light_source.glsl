// A point of a surface and a light.

vec3 hit_point(Triangle triangle, float u, float v) {
  precise float w = 1.0 - u - v;
  precise vec3 point = triangle.a * w + triangle.b * u + triangle.c * v;
  return point;
}

// Not of unit length.
vec3 towards(LightSource light, vec3 point) {
  if (light.kind == LIGHT_DIRECTIONAL) return light.place;
  precise vec3 direction = light.place - point;
  return direction;
}
