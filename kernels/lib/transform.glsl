// A transform of three rows, in a fixed order of operations. Whatever is denormal or -0 becomes +0, intermediate
// results too, so that it is all the same which devices flush denormals. Each operation is monotonic in each operand.
#ifndef COPPICE_LIB_TRANSFORM
#define COPPICE_LIB_TRANSFORM
#include "lib/finite.glsl"

// Rows of (x, y, z, translation).
struct Transform {
  vec4 rows[3];
};

float product(float a, float b) {
  precise float rounded = a * b;
  return flushed(rounded);
}

float sum(float a, float b) {
  precise float rounded = a + b;
  return flushed(rounded);
}

vec4 flushed_row(vec4 row) { return vec4(flushed(row.x), flushed(row.y), flushed(row.z), flushed(row.w)); }

// By a flushed row.
float transformed(vec4 row, vec3 position) {
  return sum(sum(sum(product(row.x, position.x), product(row.y, position.y)), product(row.z, position.z)), row.w);
}

vec3 transformed(Transform by, vec3 position) {
  return vec3(transformed(by.rows[0], position), transformed(by.rows[1], position), transformed(by.rows[2], position));
}

#endif
