// What the stages of paths share.
#ifndef COPPICE_LIB_PATH
#define COPPICE_LIB_PATH
#include "interface/paths.h"
#include "lib/device_count.glsl"
#include "lib/exact_vector.glsl"
#include "lib/ray_words.glsl"

const float PI = 3.14159274;

uint path_dimension(uint bounce, uint use) { return bounce * PATH_DIMENSIONS + use; }

void add_radiance(Vec3Buffer radiance, uint pixel, vec3 throughput, vec3 colour) {
  precise vec3 sum = radiance.at[pixel] + throughput * colour;
  radiance.at[pixel] = sum;
}

// On the side that the ray comes from.
vec3 normal_towards(Triangle triangle, vec3 direction) {
  vec3 normal = normal_of(triangle);
  return exact_dot(normal, unit(direction)) > 0.0 ? -normal : normal;
}

// Power heuristic: the weight of a sample of density 1 where the other strategy has that of `ratio`.
float power_weight(float ratio) {
  precise float weight = 1.0 / (1.0 + ratio * ratio);
  return weight;
}

#endif
