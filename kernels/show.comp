// In:  hits, and what the view shows. Out: radiance, added up over the samples of a pixel, in the place of shade; and the
// range of steps or depths. All but normals is exact arithmetic.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "interface/show.h"
#include "lib/colour_of_id.glsl"
#include "lib/exact_vector.glsl"

layout(local_size_x = SHOW_GROUP) in;
layout(push_constant, scalar) uniform Push { ShowArgs args; };
layout(constant_id = 0) const uint SHOW_VIEW = SHOW_IDS;

const float MOST_STEPS = 16777216.0;

vec3 colour_of_value(float value) {
  ShowScale scale = args.scale.at[0];
  precise float place = (value - scale.least) * scale.per_unit;
  uint index = place > 0.0 ? uint(min(place, float(SHOW_MAP_COLOURS - 1u))) : 0u;
  return args.colour_map.at[index];
}

vec3 colour_of_normal(Triangle triangle) {
  vec3 normal = normal_of(triangle);
  precise vec3 seen = normal * 0.5 + 0.5;
  precise vec3 colour = seen * seen;
  return colour;
}

// Of two levels a hit's triangle is the ray's index (place_hits).
bool has_instances() { return uint64_t(args.hit_instances) != 0ul; }
uint instance_of(uint i) { return has_instances() ? args.hit_instances.at[i] : 0u; }

uint id_of(uint i, uint triangle) {
  if (!has_instances()) return triangle;
  return args.hit_primitives.at[i] + args.hit_instances.at[i] * SHOW_INSTANCE_STRIDE;
}

uint word_of(uint i, uint triangle) {
  return args.primitive_values.at[has_instances() ? args.hit_instances.at[i] : triangle];
}

// The line of sight has length 1 in the ray's direction, so t is the depth.
vec3 colour_of_hit(uint i, uint triangle) {
  if (SHOW_VIEW == SHOW_DEPTH) return colour_of_value(args.hits.at[i].t);
  if (SHOW_VIEW == SHOW_NORMALS) return colour_of_normal(args.triangles.at[triangle]);
  if (SHOW_VIEW == SHOW_RANKS) return colour_of_value(float(word_of(i, triangle)));
  if (SHOW_VIEW == SHOW_INSTANCES) return colour_of_id(instance_of(i));
  return colour_of_id(SHOW_VIEW == SHOW_GROUPS ? word_of(i, triangle) : id_of(i, triangle));
}

// Partners: all subgroups of all dispatches for the picture.
void note_value(bool counts, uint value) {
  uint least_complement = subgroupMax(counts ? ~value : 0u), greatest = subgroupMax(counts ? value : 0u);
  if (subgroupElect()) {
    atomicMax(args.range.at[0].least_complement, least_complement);
    atomicMax(args.range.at[0].greatest, greatest);
  }
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool present = i < args.ray_count;
  uint triangle = present ? args.hits.at[i].triangle : NO_TRIANGLE;
  uint steps = SHOW_VIEW == SHOW_STEPS && present ? args.ray_steps.at[i] : 0u;
  if (SHOW_VIEW == SHOW_STEPS) note_value(present, steps);
  if (SHOW_VIEW == SHOW_DEPTH)
    note_value(triangle != NO_TRIANGLE, triangle != NO_TRIANGLE ? floatBitsToUint(args.hits.at[i].t) : 0u);
  if (!present) return;
  vec3 colour = vec3(SHOW_NOTHING);
  if (SHOW_VIEW == SHOW_STEPS) colour = colour_of_value(min(float(steps), MOST_STEPS));
  else if (triangle != NO_TRIANGLE) colour = colour_of_hit(i, triangle);
  precise vec3 sum = colour;
  if (args.sample_index != 0u) sum = args.radiance.at[i] + colour;
  args.radiance.at[i] = sum;
}
