// An instance's transform, near inverse and room; docs/numerics.md, "Instances", has the bounds.
#ifndef COPPICE_LIB_INSTANCE
#define COPPICE_LIB_INSTANCE
#include "lib/selected.glsl"
#include "lib/transform.glsl"
#include "lib/instance_words.glsl"

const float FLT_LARGEST = 3.40282346638528859812e38;
const float INSTANCE_ROUNDING = 9.5367431640625e-7;       // 16 * 2^-24
const float INSTANCE_ROOM = 1.9073486328125e-6;           // 32 * 2^-24
const float INSTANCE_CLAMP = 4.76837158203125e-7;         // 2^-21: of the room, 2^-40 of a row's sum
const float INSTANCE_SLACK = 1.0009765625;                // 1 + 2^-10
const float INSTANCE_LEAST = 7.52316384526264005100e-37;  // 2^-120
const float INSTANCE_LOW = 8.67361737988403547206e-19;    // 2^-60
const float INSTANCE_HIGH = 1.15292150460684697600e18;    // 2^60

bool finite(Transform t) {
  return finite(t.rows[0].xyz) && finite(t.rows[1].xyz) && finite(t.rows[2].xyz) && finite(t.rows[0].w) &&
         finite(t.rows[1].w) && finite(t.rows[2].w);
}

// What transformed() makes of any point of the box lies between, as every operation is monotonic.
vec2 transformed_range(vec4 row, Aabb box) {
  vec3 low = vec3(product(row.x, box.box_min.x), product(row.y, box.box_min.y), product(row.z, box.box_min.z));
  vec3 high = vec3(product(row.x, box.box_max.x), product(row.y, box.box_max.y), product(row.z, box.box_max.z));
  vec3 least = lesser(low, high), most = greater(low, high);
  return vec2(sum(sum(sum(least.x, least.y), least.z), row.w), sum(sum(sum(most.x, most.y), most.z), row.w));
}

// Of the corners that are finite. A range that overflows has all floats.
Aabb transformed_box(Transform by, Aabb box) {
  Aabb result;
  [[unroll]] for (int axis = 0; axis < 3; ++axis) {
    vec2 range = transformed_range(by.rows[axis], box);
    result.box_min[axis] = finite(range.x) ? range.x : -FLT_LARGEST;
    result.box_max[axis] = finite(range.y) ? range.y : FLT_LARGEST;
  }
  return result;
}

// The power of two that brings the largest of a column to [1, 2).
float column_scale(vec3 column) {
  uvec3 exponents = (floatBitsToUint(column) >> 23) & 0xffu;
  uint largest_exponent = clamp(max(max(exponents.x, exponents.y), exponents.z), 1u, 253u);
  return uintBitsToFloat((254u - largest_exponent) << 23);
}

vec3 scaled(vec3 v, float by) { return vec3(product(v.x, by), product(v.y, by), product(v.z, by)); }

float minor(float a, float b, float c, float d) { return sum(product(a, d), -product(b, c)); }

vec3 cross_of(vec3 v, vec3 w) {
  return vec3(minor(v.y, v.z, w.y, w.z), minor(v.z, v.x, w.z, w.x), minor(v.x, v.y, w.x, w.y));
}

float dot_of(vec3 v, vec3 w) { return sum(sum(product(v.x, w.x), product(v.y, w.y)), product(v.z, w.z)); }

// Of a number of magnitude 2^-126 to 2^10, by Newton's iteration: division is not the same on every device.
float near_reciprocal(float x) {
  uint bits = floatBitsToUint(x);
  precise float half_mantissa = uintBitsToFloat((bits & 0x007fffffu) | 0x3f000000u);  // in [0.5, 1)
  precise float r = 2.82352948 - 1.88235295 * half_mantissa;
  [[unroll]] for (int i = 0; i < 3; ++i) r = r * (2.0 - half_mantissa * r);
  float scale = uintBitsToFloat((252u - ((bits >> 23) & 0xffu)) << 23);  // 2 to the power of what is left, less 1
  precise float result = r * scale;
  precise float doubled = result + result;
  return uintBitsToFloat(floatBitsToUint(doubled) | (bits & 0x80000000u));
}

// Rows of a matrix near the inverse; of zeroes where the determinant is 0.
mat3 near_inverse_rows(vec3 row_x, vec3 row_y, vec3 row_z) {
  vec3 a = vec3(row_x.x, row_y.x, row_z.x), b = vec3(row_x.y, row_y.y, row_z.y), c = vec3(row_x.z, row_y.z, row_z.z);
  vec3 scale = vec3(column_scale(a), column_scale(b), column_scale(c));
  a = scaled(a, scale.x);
  b = scaled(b, scale.y);
  c = scaled(c, scale.z);
  vec3 bc = cross_of(b, c), ca = cross_of(c, a), ab = cross_of(a, b);
  float determinant = dot_of(a, bc);
  if (determinant == 0.0) return mat3(0.0);
  float r = near_reciprocal(determinant);
  return mat3(scaled(scaled(bc, r), scale.x), scaled(scaled(ca, r), scale.y), scaled(scaled(ab, r), scale.z));
}

float reach_on(float low, float high) { return greater(abs(low), abs(high)); }
float absolute_sum(vec3 v) { return sum(sum(abs(v.x), abs(v.y)), abs(v.z)); }

// Pad and room of one axis of the mesh. `way`: the farthest that the mesh's positions are moved on each axis of the
// world, and with the translations.
vec2 pad_and_room(vec3 inverse_row, uint axis, Transform by, vec3 reach, vec3 way, vec3 way_and_move) {
  float room = product(INSTANCE_ROOM, absolute_sum(inverse_row));
  vec3 rest;  // of the unit matrix less inverse times transform: the row of this axis
  [[unroll]] for (uint j = 0u; j < 3u; ++j) {
    vec3 column = vec3(by.rows[0][j], by.rows[1][j], by.rows[2][j]);
    rest[j] = sum(j == axis ? 1.0 : 0.0, -dot_of(inverse_row, column));
  }
  float rounding = product(INSTANCE_ROUNDING, sum(reach[axis], dot_of(abs(inverse_row), way_and_move)));
  float largest_way = greater(greater(way.x, way.y), way.z);
  float pad = sum(sum(dot_of(abs(rest), reach), rounding), product(room, largest_way));
  float least = product(INSTANCE_LEAST, sum(sum(absolute_sum(reach), absolute_sum(inverse_row)), 1.0));
  return vec2(sum(product(pad, INSTANCE_SLACK), least), room);
}

bool is_within_range(float x) { return x >= INSTANCE_LOW && x <= INSTANCE_HIGH; }

PlacedInstance placed_instance(Transform by, Aabb mesh_box, uint mesh) {
  vec3 reach = vec3(reach_on(mesh_box.box_min.x, mesh_box.box_max.x), reach_on(mesh_box.box_min.y, mesh_box.box_max.y),
                    reach_on(mesh_box.box_min.z, mesh_box.box_max.z));
  vec3 x = by.rows[0].xyz, y = by.rows[1].xyz, z = by.rows[2].xyz;
  vec3 way = vec3(dot_of(abs(x), reach), dot_of(abs(y), reach), dot_of(abs(z), reach));
  vec3 way_and_move = vec3(sum(way.x, abs(by.rows[0].w)), sum(way.y, abs(by.rows[1].w)), sum(way.z, abs(by.rows[2].w)));
  mat3 rows = near_inverse_rows(x, y, z);
  bool is_good = way_and_move.x <= INSTANCE_HIGH && way_and_move.y <= INSTANCE_HIGH && way_and_move.z <= INSTANCE_HIGH;
  vec3 pad, room;
  [[unroll]] for (uint axis = 0u; axis < 3u; ++axis) {
    vec2 both = pad_and_room(rows[axis], axis, by, reach, way, way_and_move);
    pad[axis] = both.x;
    room[axis] = both.y;
    is_good = is_good && is_within_range(absolute_sum(rows[axis])) && both.x <= INSTANCE_HIGH;
    is_good = is_good && reach[axis] <= INSTANCE_HIGH;
  }
  if (!is_good) {
    rows = mat3(0.0);
    room = vec3(1.0);
    pad = vec3(uintBitsToFloat(0x7f800000u));
  }
  return PlacedInstance(rows[0], room.x, rows[1], room.y, rows[2], room.z, pad, mesh);
}

#endif
