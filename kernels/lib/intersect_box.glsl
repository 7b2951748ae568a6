// Slab test that never loses a hit to rounding: Ize 2013, "Robust BVH Ray Traversal"; the bound is derived in
// docs/numerics.md.

const float SLAB_PAD = 1.00000095367431640625;  // 1 + 2^-20: also where a division is off by 2.5 ulp

struct BoxRay {
  vec3 origin;
  vec3 inverse;  // reciprocal direction; infinite, with the sign kept, where a component is zero or denormal
};

float reciprocal(float x) {
  uint bits = floatBitsToUint(x);
  if ((bits & 0x7f800000u) == 0u) return uintBitsToFloat((bits & 0x80000000u) | 0x7f800000u);
  return 1.0 / x;
}

BoxRay box_ray(Ray ray) {
  return BoxRay(ray.origin, vec3(reciprocal(ray.direction.x), reciprocal(ray.direction.y), reciprocal(ray.direction.z)));
}

// A ray in the plane of a slab gives 0 * infinity; every comparison with that NaN is false and leaves the interval
// as it was, which is what such a ray needs.
void clip_to_slab(float slab_min, float slab_max, float origin, float inverse, inout float enter, inout float leave) {
  precise float t_min = (slab_min - origin) * inverse;
  precise float t_max = (slab_max - origin) * inverse;
  bool backward = inverse < 0.0;
  float near = backward ? t_max : t_min;
  precise float far = (backward ? t_min : t_max) * SLAB_PAD;
  if (near > enter) enter = near;
  if (far < leave) leave = far;
}

// `enter` comes in as the least t of interest and goes out as the t where the ray enters the box.
bool intersect_box(BoxRay ray, vec3 box_min, vec3 box_max, float leave, inout float enter) {
  clip_to_slab(box_min.x, box_max.x, ray.origin.x, ray.inverse.x, enter, leave);
  clip_to_slab(box_min.y, box_max.y, ray.origin.y, ray.inverse.y, enter, leave);
  clip_to_slab(box_min.z, box_max.z, ray.origin.z, ray.inverse.z, enter, leave);
  return enter <= leave;
}
