// Values of a subgroup whose invocations walk together. The invocations of a packet are always all active.
#include "lib/selected.glsl"
#include "lib/subgroup.glsl"

uint packet_or(uint x) {
  [[unroll]] for (uint m = 1u; m < LANES; m <<= 1) x |= subgroupShuffleXor(x, m);
  return x;
}

// Selected rather than min and max, as in intersect_triangle.glsl; by shuffles, since CPU devices go through the
// invocations one by one for the reductions of GLSL.
float packet_lesser(float x) {
  [[unroll]] for (uint m = 1u; m < LANES; m <<= 1) x = lesser(x, subgroupShuffleXor(x, m));
  return x;
}

float packet_greater(float x) {
  [[unroll]] for (uint m = 1u; m < LANES; m <<= 1) x = greater(x, subgroupShuffleXor(x, m));
  return x;
}

vec3 packet_lesser(vec3 x) { return vec3(packet_lesser(x.x), packet_lesser(x.y), packet_lesser(x.z)); }
vec3 packet_greater(vec3 x) { return vec3(packet_greater(x.x), packet_greater(x.y), packet_greater(x.z)); }
