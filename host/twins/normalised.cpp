#include "twins/normalised.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace coppice::twins {

uint ordered(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return static_cast<uint>(bits < 0 ? ~bits : bits ^ INT32_MIN);
}

float from_ordered(uint key) {
  const auto bits = static_cast<std::int32_t>(key);
  return std::bit_cast<float>(bits < 0 ? bits ^ INT32_MIN : ~bits);
}

namespace {

Aabb box_of(const BuildState& state) {
  Aabb box{vec3(0), vec3(0)};
  if (state.active_count == 0) return box;
  for (int axis = 0; axis < 3; ++axis) {
    box.box_min[axis] = from_ordered(~state.box_min_complement[axis]);
    box.box_max[axis] = from_ordered(state.box_max[axis]);
  }
  return box;
}

}  // namespace

Normalisation::Normalisation(const BuildState& state) : Normalisation(box_of(state)) {}

Normalisation::Normalisation(const Aabb& scene_box) : scene_box_(scene_box), exponent_(0) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::fabs(scene_box_.box_min[axis]), std::fabs(scene_box_.box_max[axis])});
  }
  exponent_ = largest > 0 ? 59 - std::ilogb(largest) : 0;
}

vec3 Normalisation::operator()(vec3 position) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double scaled = std::ldexp(static_cast<double>(position[axis]), exponent_);
    position[axis] = std::fabs(scaled) < std::ldexp(1.0, -40) ? 0.0f : static_cast<float>(scaled);
  }
  return position;
}

float union_area(const Aabb& a, const Aabb& b) {
  float extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    extent[axis] = std::max(a.box_max[axis], b.box_max[axis]) - std::min(a.box_min[axis], b.box_min[axis]);
  }
  return extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0];
}

}  // namespace coppice::twins
