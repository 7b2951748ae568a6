#ifndef COPPICE_LIB_HIT_POINT
#define COPPICE_LIB_HIT_POINT

// Where a hit lies in its triangle.
vec3 hit_point(Triangle triangle, float u, float v) {
  precise float w = 1.0 - u - v;
  precise vec3 point = triangle.a * w + triangle.b * u + triangle.c * v;
  return point;
}

#endif
