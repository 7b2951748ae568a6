// Products in a fixed order, without contraction.
#ifndef COPPICE_LIB_EXACT_VECTOR
#define COPPICE_LIB_EXACT_VECTOR

vec3 exact_cross(vec3 a, vec3 b) {
  precise vec3 product = a.yzx * b.zxy - a.zxy * b.yzx;
  return product;
}

float exact_dot(vec3 a, vec3 b) {
  precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// Divided by the largest component first: squares of large coordinates overflow, of small ones vanish. Zero for zero.
vec3 unit(vec3 v) {
  vec3 size = abs(v);
  float largest = max(max(size.x, size.y), size.z);
  if (largest == 0.0) return vec3(0.0);
  precise vec3 scaled = v / largest;
  precise vec3 result = scaled / sqrt(exact_dot(scaled, scaled));
  return result;
}

// Unit length; zero for a triangle without area.
vec3 normal_of(Triangle triangle) {
  precise vec3 edge_b = triangle.b - triangle.a;
  precise vec3 edge_c = triangle.c - triangle.a;
  return unit(exact_cross(unit(edge_b), unit(edge_c)));
}

#endif
