// Boxes of a refit. The including kernel's `args` tell the triangles.
#ifndef COPPICE_LIB_REFIT_BOX
#define COPPICE_LIB_REFIT_BOX
#include "lib/finite.glsl"
#include "lib/triangle_words.glsl"

Aabb nothing_box() { return Aabb(vec3(NOTHING_BOX), vec3(-NOTHING_BOX)); }

// As finite() of every coordinate, with fewer instructions.
bool is_active(Triangle t) {
  uvec3 bits = max(max(floatBitsToUint(abs(t.a)), floatBitsToUint(abs(t.b))), floatBitsToUint(abs(t.c)));
  return max(max(bits.x, bits.y), bits.z) < EXPONENT_BITS;
}

// Selected rather than min and max: see union_area in lib/ploc_box.glsl.
vec3 lower(vec3 a, vec3 b) { return mix(a, b, lessThan(b, a)); }
vec3 upper(vec3 a, vec3 b) { return mix(a, b, greaterThan(b, a)); }

// That of its triangle as it lies now.
Node refitted_leaf(uint triangle) {
  Triangle t = load_triangle(args.triangles, triangle);
  Aabb box = nothing_box();
  if (is_active(t)) box = Aabb(lower(lower(t.a, t.b), t.c), upper(upper(t.a, t.b), t.c));
  return Node(box.box_min, triangle, box.box_max, 0u);
}

Node refitted_parent(Node left, Node right, uint first_child, uint height) {
  return Node(lower(left.box_min, right.box_min), first_child, upper(left.box_max, right.box_max), height);
}

#endif
