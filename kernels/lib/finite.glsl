#ifndef COPPICE_LIB_FINITE
#define COPPICE_LIB_FINITE
// By bits, as no device may compare denormals and NaN otherwise than the others.

const uint EXPONENT_BITS = 0x7f800000u;

bool finite(float x) { return (floatBitsToUint(x) & EXPONENT_BITS) != EXPONENT_BITS; }
bool finite(vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }

// +0 for -0 and denormals.
float flushed(float x) { return (floatBitsToUint(x) & EXPONENT_BITS) == 0u ? 0.0 : x; }
vec3 flushed(vec3 v) { return vec3(flushed(v.x), flushed(v.y), flushed(v.z)); }

#endif
