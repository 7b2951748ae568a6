#pragma once

#include "interface/instances.h"

namespace coppice::twins {

// A transform as gather_triangles takes it: denormals and -0 of what comes in and of every result are +0.
class Affine {
 public:
  explicit Affine(const InstanceTransform& transform);

  bool is_finite() const;
  vec3 operator()(const vec3& position) const;
  // About all that becomes of points of the box; where that overflows about all floats.
  Aabb operator()(const Aabb& box) const;

  float at[3][4];  // rows; the last column is the translation
};

// What rays of an instance of a mesh whose root has that box need.
PlacedInstance place(const Affine& transform, const Aabb& mesh_box, uint mesh);

}  // namespace coppice::twins
