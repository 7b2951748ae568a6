#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace coppice {

enum class Interpolation { step, linear, cubic };

// Values at times, and what lies between them (glTF 2.0, appendix C).
struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool is_rotation = false;   // quaternions x y z w: linear is slerp, cubic is normalised
  std::uint32_t width = 3;    // numbers a value
  std::vector<double> times;  // seconds, rising; at least one
  // time * width; cubic: three of width a time, the tangent that comes in, the value, the tangent that goes
  // out, tangents in units a second
  std::vector<double> values;
};

// The value at that time into `result` of `width`; before the first and after the last time that one's.
void sample(const Keyframes& keyframes, double seconds, std::span<double> result);

// The tangents of a curve through the values without a jump in speed (Catmull-Rom): makes values of linear
// keyframes cubic.
void smooth(Keyframes& keyframes);

}  // namespace coppice
