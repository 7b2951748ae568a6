#pragma once

#include "interface/types.h"

namespace coppice::twins {

// Order-preserving bijection between finite floats and unsigned integers.
uint ordered(float x);
float from_ordered(uint key);

// The scene's box as the bounds stage left it, and world units to normalised ones; docs/numerics.md.
class Normalisation {
 public:
  explicit Normalisation(const BuildState& state);
  explicit Normalisation(const Aabb& scene_box);
  vec3 operator()(vec3 position) const;
  Aabb scene_box() const { return scene_box_; }

 private:
  Aabb scene_box_;
  int exponent_;
};

// Half the area of the union of two normalised boxes.
float union_area(const Aabb& a, const Aabb& b);

}  // namespace coppice::twins
