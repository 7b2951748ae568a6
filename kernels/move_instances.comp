// In:  a time. Out: the transforms of a swarm of instances, which circle the axis y and tumble. Multiplications,
// additions and integers only, in a fixed order: the same bits on every device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/instances.h"
#include "lib/on_circle.glsl"
#include "lib/random.glsl"

layout(local_size_x = MOVE_INSTANCES_GROUP) in;
layout(push_constant, scalar) uniform Push { MoveInstancesArgs args; };

// In [0, 1), a multiple of 2^-24.
float next_part(inout uint state) { return float(next_random(state) >> 8) * 5.9604644775390625e-8; }

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.instance_count) return;
  uint state = i ^ (args.seed * 0x9e3779b9u);
  next_random(state);
  float swarm = uintBitsToFloat(args.exponent << 23);
  precise float radius = swarm * (0.125 + 0.875 * next_part(state));
  precise float height = swarm * 0.5 * next_signed(state);
  precise float size = 0.25 + 0.75 * next_part(state);
  uint laps = 1u + (next_random(state) >> 30);
  vec2 orbit = on_circle(next_random(state) + laps * args.turn);
  vec2 tumble = on_circle(next_random(state) + 2u * laps * args.turn);
  float mirrored = (i & 1u) == 0u ? size : -size;
  precise float x = radius * orbit.x, z = radius * orbit.y;
  precise vec3 row_x = vec3(orbit.x * mirrored, orbit.y * tumble.y * size, orbit.y * tumble.x * size);
  precise vec3 row_y = vec3(0.0, tumble.x * size, -tumble.y * size);
  precise vec3 row_z = vec3(-orbit.y * mirrored, orbit.x * tumble.y * size, orbit.x * tumble.x * size);
  args.transforms.at[i] = InstanceTransform(row_x, x, row_y, height, row_z, z);
}
