// The length of a vector whose square may be too large or too small. Include lib/exact_vector.glsl before.
#ifndef COPPICE_LIB_LENGTH
#define COPPICE_LIB_LENGTH

float length_of(vec3 v) {
  vec3 size = abs(v);
  float largest = max(max(size.x, size.y), size.z);
  if (largest == 0.0) return 0.0;
  precise vec3 scaled = v / largest;
  precise float length = largest * sqrt(exact_dot(scaled, scaled));
  return length;
}

#endif
