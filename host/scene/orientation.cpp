#include "scene/orientation.h"

#include <array>
#include <cmath>

namespace coppice {
namespace {

int sign(double x) { return (x > 0) - (x < 0); }

// The sign of a sum of doubles, none of which is so large or small that a part of it is lost: the sum as
// components that do not overlap (Shewchuk 1997, grow-expansion), of which the last that is not 0 decides.
int sign_of_sum(const std::array<double, 6>& terms) {
  std::array<double, 6> components{};
  for (std::size_t count = 0; count < terms.size(); ++count) {
    double sum = terms[count];
    for (std::size_t i = 0; i < count; ++i) {
      const double a = sum, b = components[i];
      sum = a + b;
      const double b_rounded = sum - a;
      components[i] = (a - (sum - b_rounded)) + (b - b_rounded);
    }
    components[count] = sum;
  }
  for (std::size_t i = components.size(); i-- > 0;) {
    if (components[i] != 0) return sign(components[i]);
  }
  return 0;
}

}  // namespace

int orientation(glm::vec2 a_float, glm::vec2 b_float, glm::vec2 c_float) {
  const glm::dvec2 a{a_float}, b{b_float}, c{c_float};
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  // Four roundings of 2^-53 each; nothing underflows, for the least float squared is 2^-298.
  if (std::abs(left - right) > 0x1p-51 * (std::abs(left) + std::abs(right))) return sign(left - right);
  // Products of two floats are exact in double.
  return sign_of_sum({a.x * b.y, -a.y * b.x, b.x * c.y, -b.y * c.x, c.x * a.y, -c.y * a.x});
}

}  // namespace coppice
