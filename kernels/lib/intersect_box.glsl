// Slab test: Kay and Kajiya 1986. Fast compares the distances as they come; robust widens each slab by a pad, so that no
// rounding of this test or of the watertight triangle test loses a hit: Ize 2013, "Robust BVH Ray Traversal"; Woop,
// Benthin and Wald 2013, section 3.3. The pad follows from the ray and from how far the box reaches from its origin, so
// it is as small as the box is near and small. The bound is derived in docs/numerics.md.
#ifndef COPPICE_LIB_INTERSECT_BOX
#define COPPICE_LIB_INTERSECT_BOX
#include "trace_ray.glsl"

// A ray in the plane of a slab gives 0 * infinity; every comparison with that NaN is false and leaves the interval
// as it was, which is what such a ray needs.
void clip_to_slab(float slab_min, float slab_max, float origin, float inverse, float pad, inout float enter,
                  inout float leave) {
  precise float t_min = (slab_min - origin) * inverse;
  precise float t_max = (slab_max - origin) * inverse;
  bool backward = inverse < 0.0;
  precise float near = backward ? t_max : t_min;
  precise float far = backward ? t_min : t_max;
  if (TRACE_BOX_TEST == BOX_ROBUST) {
    near = near - pad;
    far = far + pad;
  }
  if (near > enter) enter = near;
  if (far < leave) leave = far;
}

// For a box no corner of which is farther from the origin than `reach`, in the maximum norm. `enter` comes in as the
// least t of interest and goes out as the t where the ray enters the box.
bool intersect_box_within(TraceRay ray, vec3 box_min, vec3 box_max, float reach, float leave, inout float enter) {
  precise vec3 pad = ray.room * reach;
  clip_to_slab(box_min.x, box_max.x, ray.origin.x, ray.inverse.x, pad.x, enter, leave);
  clip_to_slab(box_min.y, box_max.y, ray.origin.y, ray.inverse.y, pad.y, enter, leave);
  clip_to_slab(box_min.z, box_max.z, ray.origin.z, ray.inverse.z, pad.z, enter, leave);
  return enter <= leave;
}

bool intersect_box(TraceRay ray, vec3 box_min, vec3 box_max, float leave, inout float enter) {
  precise vec3 to_min = box_min - ray.origin;
  precise vec3 to_max = box_max - ray.origin;
  float reach = TRACE_BOX_TEST == BOX_ROBUST ? largest(to_min, to_max) : 0.0;
  return intersect_box_within(ray, box_min, box_max, reach, leave, enter);
}

#endif
