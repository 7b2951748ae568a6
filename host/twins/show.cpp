#include "interface/show.h"

#include <algorithm>
#include <bit>

#include "twins/vectors.h"

namespace coppice::twins {

namespace {

vec3 of_map(const ShowArgs& args, float value) {
  const ShowScale& scale = args.scale[0];
  const float place = (value - scale.least) * scale.per_unit;
  if (!(place > 0)) return args.colour_map[0];
  const uint last = SHOW_MAP_COLOURS - 1;
  return args.colour_map[place < static_cast<float>(last) ? static_cast<uint>(place) : last];
}

// A quarter and three quarters of each byte of the hash, squared.
vec3 of_id(uint id) {
  const uint state = id * 747796405u + 2891336453u;
  uint hash = (state >> ((state >> 28) + 4) ^ state) * 277803737u;
  hash ^= hash >> 22;
  vec3 colour;
  for (int channel = 0; channel < 3; ++channel) {
    const float seen = static_cast<float>(hash >> (8 * channel) & 0xff) * (3 / 1024.0f) + 0.25f;
    colour[channel] = seen * seen;
  }
  return colour;
}

vec3 of_normal(const Triangle& triangle) {
  const vec3 seen = unit_normal(triangle) * 0.5f + vec3(0.5f);
  return seen * seen;
}

void note(ShowRange& range, uint value) {
  range.least_complement = std::max(range.least_complement, ~value);
  range.greatest = std::max(range.greatest, value);
}

// Of the tree that is shown: a triangle, or an instance.
uint primitive_of(const ShowArgs& args, uint i) {
  return args.hit_instances.value ? args.hit_instances[i] : args.hits[i].triangle;
}

vec3 of_ray(const ShowArgs& args, uint i) {
  const Hit& hit = args.hits[i];
  if (args.view == SHOW_STEPS) {
    note(args.range[0], args.ray_steps[i]);
    return of_map(args, static_cast<float>(std::min(args.ray_steps[i], 1u << 24)));
  }
  if (hit.triangle == NO_TRIANGLE) return vec3(SHOW_NOTHING);
  switch (args.view) {
    case SHOW_NORMALS:
      return of_normal(args.triangles[hit.triangle]);
    case SHOW_DEPTH:
      note(args.range[0], std::bit_cast<uint>(hit.t));
      return of_map(args, hit.t);
    case SHOW_RANKS:
      return of_map(args, static_cast<float>(args.primitive_values[primitive_of(args, i)]));
    case SHOW_GROUPS:
      return of_id(args.primitive_values[primitive_of(args, i)]);
    case SHOW_INSTANCES:
      return of_id(args.hit_instances.value ? args.hit_instances[i] : 0);
    default:
      if (!args.hit_instances.value) return of_id(hit.triangle);
      return of_id(args.hit_instances[i] * SHOW_INSTANCE_STRIDE + args.hit_primitives[i]);
  }
}

}  // namespace

void show(const ShowArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    const vec3 colour = of_ray(args, i);
    args.radiance[i] = args.sample_index == 0 ? colour : args.radiance[i] + colour;
  }
}

}  // namespace coppice::twins
