#pragma once

#include "interface/types.h"

namespace coppice {

// World coordinates times the power of two that puts the scene's largest absolute coordinate into
// [2^59, 2^60), with magnitudes below 2^-40 set to 0. The product of any two lengths is then neither beyond
// the range of float nor denormal, whatever the unit of the scene, and nothing is rounded that is not set to
// 0. The map is monotonic, so it commutes with unions of boxes.
class NormalisedSpace {
 public:
  // `scene`: a box with finite corners.
  explicit NormalisedSpace(const Aabb& scene);

  // `world`: a box inside of the scene box.
  Aabb operator()(const Aabb& world) const { return {(*this)(world.box_min), (*this)(world.box_max)}; }
  vec3 operator()(const vec3& world) const {
    return {normalised(world.x), normalised(world.y), normalised(world.z)};
  }

 private:
  float normalised(float world) const {
    const float scaled = world * factor_ * other_factor_;
    return scaled < 0x1p-40f && scaled > -0x1p-40f ? 0.0f : scaled;
  }

  // The power of two as a product: by itself it may be beyond the range of float.
  float factor_ = 1.0f;
  float other_factor_ = 1.0f;
};

}  // namespace coppice
