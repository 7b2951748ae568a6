#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace coppice {

// A place of its own for directions, in double: x and y at right angles to a unit normal.
struct Directions {
  glm::dvec3 x, y, normal;

  explicit Directions(const glm::vec3& n) : normal(n) {
    const glm::dvec3 other = std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    x = crossed(other, normal);
    x /= std::sqrt(x.x * x.x + x.y * x.y + x.z * x.z);
    y = crossed(normal, x);
  }

  glm::vec3 at(double cosine, double phi) const {
    const double sine = std::sqrt(1 - cosine * cosine);
    return glm::vec3(x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + normal * cosine);
  }

  // (cosine, phi / 2 pi in [0, 1)).
  glm::dvec2 of(const glm::vec3& v) const {
    const glm::dvec3 d(v);
    const double turns = std::atan2(dotted(d, y), dotted(d, x)) / (2 * std::numbers::pi);
    return {dotted(d, normal), turns - std::floor(turns)};
  }

  static double dotted(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static glm::dvec3 crossed(const glm::dvec3& a, const glm::dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

// The integral over directions from one cosine to another and from one phi to another, given in turns, by so
// many steps of each.
template <class Value, class Function>
Value integral_over(const Directions& directions, glm::dvec2 cosines, glm::dvec2 turns, glm::ivec2 steps,
                    Function function) {
  Value sum(0);
  const double cosine_step = (cosines.y - cosines.x) / steps.x;
  const double phi_step = 2 * std::numbers::pi * (turns.y - turns.x) / steps.y;
  for (int i = 0; i < steps.x; ++i)
    for (int j = 0; j < steps.y; ++j) {
      const double phi = 2 * std::numbers::pi * turns.x + phi_step * (j + 0.5);
      sum += Value(function(directions.at(cosines.x + cosine_step * (i + 0.5), phi)));
    }
  return sum * (cosine_step * phi_step);
}

}  // namespace coppice
