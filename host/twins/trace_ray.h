#pragma once

#include "interface/trace.h"

namespace coppice::twins {

// A ray made ready for the intersection tests of the twins; what lib/trace_ray.glsl is to the kernels. The
// bounds are in docs/numerics.md, "Rays".
class TraceRay {
 public:
  // `is_sound` is false for a ray that hits nothing.
  explicit TraceRay(const Ray& given);

  // Moves an origin far outside of the scene's box to just before it.
  void approach(const vec3& box_min, const vec3& box_max);

  Hit prepared(const Hit& given) const;
  // What a t of the prepared ray is for the ray as given; may be infinite.
  float given_t(float t) const { return (t + moved_) * scale_; }
  // Replaces `so_far`, a hit of the ray as given, by `hit`, one of the prepared ray, unless they are the
  // same.
  void keep(const Hit& hit, Hit& so_far) const;

  bool is_sound = false;
  vec3 origin, direction;
  float t_min;
  vec3 inverse;
  vec3 room{0};    // t by which the robust box test widens slabs, for a corner of the box one unit away
  int axis;        // largest component of the direction
  float shear[2];  // of the two axes that follow `axis` in cyclic order
  float stretch;   // reciprocal of the largest component

 private:
  float moved_ = 0;  // t by which the origin was moved
  float scale_;      // of the direction
  Ray given_;
};

}  // namespace coppice::twins
