// In:  transforms at rest and a time. Out: each instance on its way around the axis y, tumbling. Multiplications,
// additions and integers only, in a fixed order: the same bits on every device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/instances.h"
#include "lib/random.glsl"
#include "lib/transform.glsl"
#include "lib/turn.glsl"

layout(local_size_x = MOVE_INSTANCES_GROUP) in;
layout(push_constant, scalar) uniform Push { MoveInstancesArgs args; };

// (cosine a - sine b, sine a + cosine b)
vec2 rotated(vec2 by, float a, float b) {
  return vec2(sum(product(by.x, a), -product(by.y, b)), sum(product(by.y, a), product(by.x, b)));
}

// Around the axis x of the mesh, before the transform.
vec4 tumbled(vec2 by, vec3 row, float move) {
  vec4 rest = flushed_row(vec4(row, move));
  vec2 across = rotated(by, rest.z, rest.y);
  return vec4(rest.x, across.y, across.x, rest.w);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.instance_count) return;
  uint state = i ^ (args.seed * 0x9e3779b9u);
  uint laps = 1u + (next_random(state) >> 30);
  uint part = laps * args.turn.at[0];
  vec2 orbit = part_of_turn(part), tumble = part_of_turn(2u * part);
  InstanceTransform rest = args.rest.at[i];
  vec4 x = tumbled(tumble, rest.row_x, rest.move_x);
  vec4 y = tumbled(tumble, rest.row_y, rest.move_y);
  vec4 z = tumbled(tumble, rest.row_z, rest.move_z);
  vec4 moved_x, moved_z;
  [[unroll]] for (int column = 0; column < 4; ++column) {
    vec2 place = rotated(orbit, x[column], z[column]);
    moved_x[column] = place.x;
    moved_z[column] = place.y;
  }
  args.transforms.at[i] = InstanceTransform(moved_x.xyz, moved_x.w, y.xyz, y.w, moved_z.xyz, moved_z.w);
}
