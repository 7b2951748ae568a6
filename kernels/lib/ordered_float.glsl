#ifndef COPPICE_LIB_ORDERED_FLOAT
#define COPPICE_LIB_ORDERED_FLOAT
// Order-preserving bijection between finite floats and unsigned integers, for atomic minima and maxima.

uint ordered(float x) {
  uint bits = floatBitsToUint(x);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float from_ordered(uint key) {
  return uintBitsToFloat((key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key);
}

uvec3 ordered(vec3 v) { return uvec3(ordered(v.x), ordered(v.y), ordered(v.z)); }
vec3 from_ordered(uvec3 key) { return vec3(from_ordered(key.x), from_ordered(key.y), from_ordered(key.z)); }

#endif
