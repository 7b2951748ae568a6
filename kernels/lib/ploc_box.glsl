// Normalised boxes, their distance, and whom of two neighbours a cluster prefers.
//
// Distance is the half area of the union box. Equal distances prefer the smaller gap in the list, then the parity
// rule: of the pairs (i - g, i) and (i, i + g), whose lower indices differ in the lowest set bit of g, the one that has
// it clear. Both clusters of a pair rank it alike, so the globally first pair is mutual and every round merges.
#include "lib/normalised.glsl"

const float NO_AREA = 3.402823466e38;      // above every normalised area
const float FAR = 9.223372036854775808e18;  // 2^63: a box that reaches so far has an infinite area

struct Box {
  vec3 box_min, box_max;
};

struct Nearest {
  float area;
  uint gap;
};

// Selected rather than min and max: those cost CPU devices three instructions each, for the sake of NaN.
float union_area(Box a, Box b) {
  vec3 box_min = mix(a.box_min, b.box_min, lessThan(b.box_min, a.box_min));
  vec3 box_max = mix(a.box_max, b.box_max, greaterThan(b.box_max, a.box_max));
  precise vec3 extent = box_max - box_min;
  precise float area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  return area;
}

// Of equal distances the smaller gap, then the parity rule.
uint nearer_side(uint i, Nearest left, Nearest right) {
  bool right_first = (i & left.gap & (~left.gap + 1u)) == 0u;
  bool tie_right = right.gap < left.gap || (right.gap == left.gap && right_first);
  bool take_right = right.area < left.area || (right.area == left.area && tie_right);
  return take_right ? i + right.gap : i - left.gap;
}
