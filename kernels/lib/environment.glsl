// The map of radiance from every direction: see interface/environment.h. Include lib/exact_vector.glsl before.
#ifndef COPPICE_LIB_ENVIRONMENT
#define COPPICE_LIB_ENVIRONMENT
#include "interface/environment.h"

float sign_of(float x) { return x < 0.0 ? -1.0 : 1.0; }

// From a place of the square to that of the octahedron behind it, and back: the same formula. Where `y` is negative.
vec2 folded(vec2 place) {
  precise vec2 result = (1.0 - abs(place.yx)) * vec2(sign_of(place.x), sign_of(place.y));
  return result;
}

// |p|^3
float cubed_length(vec3 p) {
  float squared = exact_dot(p, p);
  precise float cubed = squared * sqrt(squared);
  return cubed;
}

// On the octahedron, of places in texels.
vec3 octahedron_point(vec2 texels, uint side) {
  precise vec2 place = texels * (2.0 / float(side)) - 1.0;
  precise float y = 1.0 - abs(place.x) - abs(place.y);
  vec2 across = y < 0.0 ? folded(place) : place;
  return vec3(across.x, y, across.y);
}

// In the direction, which is not 0.
vec3 octahedron_point(vec3 direction) {
  vec3 size = abs(direction);
  precise float sum = size.x + size.y + size.z;
  precise vec3 p = direction / sum;
  return p;
}

vec2 texels_of(vec3 p, uint side) {
  vec2 place = p.y < 0.0 ? folded(p.xz) : p.xz;
  precise vec2 texels = (place + 1.0) * (0.5 * float(side));
  return texels;
}

vec3 texel_at(SurroundingBuffer at, ivec2 texel, int side) {
  if (texel.x < 0 || texel.x >= side) texel = ivec2(clamp(texel.x, 0, side - 1), side - 1 - texel.y);
  if (texel.y < 0 || texel.y >= side) texel = ivec2(side - 1 - texel.x, clamp(texel.y, 0, side - 1));
  return at.at[1u + uint(side) * uint(texel.y) + uint(texel.x)].radiance;
}

vec3 radiance_at(SurroundingBuffer at, vec2 texels, uint side) {
  precise vec2 from_centre = texels - 0.5;
  vec2 low = floor(from_centre);
  precise vec2 part = from_centre - low;
  ivec2 corner = ivec2(low);
  vec3 a = texel_at(at, corner, int(side)), b = texel_at(at, corner + ivec2(1, 0), int(side));
  vec3 c = texel_at(at, corner + ivec2(0, 1), int(side)), d = texel_at(at, corner + ivec2(1, 1), int(side));
  precise vec3 above = a + (b - a) * part.x, below = c + (d - c) * part.x;
  precise vec3 radiance = above + (below - above) * part.y;
  return radiance;
}

uint start_of(SurroundingBuffer at, uint first, uint index) { return index == 0u ? 0u : at.at[first + index - 1u].end; }

// By solid angle, at a place in a texel; that the environment is chosen included.
float density_at(SurroundingBuffer at, uvec2 texel, vec3 p, uint side) {
  uint first = 1u + side * texel.y;
  uint share = at.at[first + texel.x].end - start_of(at, first, texel.x);
  precise float density = at.at[1u + side * side + texel.y].radiance.x * float(share) * cubed_length(p);
  return density;
}

// Which of `side` shares from `first` on has this number of ENVIRONMENT_RANGE.
uint share_at(SurroundingBuffer at, uint first, uint side, uint number) {
  uint low = 0u, high = side - 1u;
  [[dont_unroll]] for (uint step = 0u; step < 16u && low < high; ++step) {
    uint middle = (low + high) >> 1;
    if (at.at[first + middle].end > number) {
      high = middle;
    } else {
      low = middle + 1u;
    }
  }
  return low;
}

// The share that `u` falls into, and how far into it, in texels.
float place_in_shares(SurroundingBuffer at, uint first, uint side, float u, float jitter, out uint index) {
  uint number = uint(u * float(ENVIRONMENT_RANGE));
  index = share_at(at, first, side, number);
  uint start = start_of(at, first, index);
  precise float into = (float(number - start) + jitter) / float(at.at[first + index].end - start);
  precise float place = float(index) + into;
  return place;
}

struct EnvironmentSample {
  vec3 towards;   // not of unit length
  float density;  // as density_at
  vec3 radiance;
};

EnvironmentSample sampled_environment(SurroundingBuffer at, vec2 u, vec2 jitter) {
  uint side = at.at[0].end;
  uvec2 texel;
  vec2 texels;
  texels.y = place_in_shares(at, 1u + side * side, side, u.y, jitter.y, texel.y);
  texels.x = place_in_shares(at, 1u + side * texel.y, side, u.x, jitter.x, texel.x);
  vec3 p = octahedron_point(texels, side);
  return EnvironmentSample(p, density_at(at, texel, p, side), radiance_at(at, texels, side));
}

// What a ray meets in that direction, and by which density sampled_environment would have had it.
vec3 met_environment(SurroundingBuffer at, vec3 direction, out float density) {
  uint side = at.at[0].end;
  vec3 p = octahedron_point(direction);
  vec2 texels = texels_of(p, side);
  density = density_at(at, min(uvec2(texels), uvec2(side - 1u)), p, side);
  return radiance_at(at, texels, side);
}

#endif
