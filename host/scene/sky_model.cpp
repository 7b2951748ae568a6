#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/environment.h"

namespace coppice {

namespace {

constexpr double least_cosine = 1e-4;  // of what is seen at the horizon
constexpr double haze = 0.06;          // down to this height below it the sky goes over into the ground

// Preetham et al. 1999, appendix A.2: each coefficient is slope * turbidity + offset.
using Lines = std::array<std::array<double, 2>, 5>;
constexpr Lines luminance_lines = {
    {{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}}};
constexpr Lines x_lines = {
    {{-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}}};
constexpr Lines y_lines = {
    {{-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}}};

// Chromaticity at the zenith: a row a power of turbidity, 2 to 0, of powers of the sun's angle, 3 to 0.
using Cubics = std::array<std::array<double, 4>, 3>;
constexpr Cubics x_zenith = {{{0.00166, -0.00375, 0.00209, 0},
                              {-0.02903, 0.06377, -0.03202, 0.00394},
                              {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr Cubics y_zenith = {{{0.00275, -0.00610, 0.00317, 0},
                              {-0.04214, 0.08970, -0.04153, 0.00516},
                              {0.15346, -0.26756, 0.06670, 0.26688}}};

std::array<double, 5> coefficients_of(const Lines& lines, double turbidity) {
  std::array<double, 5> coefficients;
  for (std::size_t i = 0; i < 5; ++i) coefficients[i] = lines[i][0] * turbidity + lines[i][1];
  return coefficients;
}

double zenith_chromaticity(const Cubics& rows, double turbidity, double sun_angle) {
  double result = 0;
  for (const auto& row : rows)
    result = result * turbidity + ((row[0] * sun_angle + row[1]) * sun_angle + row[2]) * sun_angle + row[3];
  return result;
}

// In kilocandela per square metre.
double zenith_luminance(double turbidity, double sun_angle) {
  const double chi = (4.0 / 9 - turbidity / 120) * (std::numbers::pi - 2 * sun_angle);
  return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}

// IEC 61966-2-1. What sRGB has no light for is left out.
glm::dvec3 linear_srgb(double x, double y, double luminance) {
  const double across = luminance / y * x, beyond = luminance / y * (1 - x - y);
  return glm::max(glm::dvec3(3.2406 * across - 1.5372 * luminance - 0.4986 * beyond,
                             -0.9689 * across + 1.8758 * luminance + 0.0415 * beyond,
                             0.0557 * across - 0.2040 * luminance + 1.0570 * beyond),
                  0.0);
}

}  // namespace

double SkyModel::Perez::at(double cosine, double angle_to_sun) const {
  const auto& [a, b, c, d, e] = coefficients;
  const double near = std::cos(angle_to_sun);
  return (1 + a * std::exp(b / cosine)) * (1 + c * std::exp(d * angle_to_sun) + e * near * near);
}

SkyModel::SkyModel(const Sky& sky) : sun_(glm::normalize(glm::dvec3(sky.sun))) {
  const double turbidity = sky.turbidity, sun_angle = std::acos(std::clamp(sun_.y, 0.0, 1.0));
  const auto made = [&](const Lines& lines, double at_zenith) {
    Perez perez{coefficients_of(lines, turbidity), at_zenith, 1};
    perez.of_zenith = perez.at(1, sun_angle);
    return perez;
  };
  luminance_ = made(luminance_lines, zenith_luminance(turbidity, sun_angle));
  x_ = made(x_lines, zenith_chromaticity(x_zenith, turbidity, sun_angle));
  y_ = made(y_lines, zenith_chromaticity(y_zenith, turbidity, sun_angle));
  // Irradiance by pi: squares of equal projected area.
  constexpr int rings = 64, sectors = 128;
  for (int i = 0; i < rings; ++i) {
    const double squared = (i + 0.5) / rings, radius = std::sqrt(squared);
    for (int k = 0; k < sectors; ++k) {
      const double turn = 2 * std::numbers::pi * (k + 0.5) / sectors;
      ground_ += above({radius * std::cos(turn), std::sqrt(1 - squared), radius * std::sin(turn)});
    }
  }
  ground_ *= sky.ground / (double{rings} * sectors);
}

glm::dvec3 SkyModel::above(const glm::dvec3& direction) const {
  const double cosine = std::max(direction.y, least_cosine);
  const double to_sun = std::acos(std::clamp(glm::dot(direction, sun_), -1.0, 1.0));
  const auto value = [&](const Perez& perez) {
    return perez.at_zenith * perez.at(cosine, to_sun) / perez.of_zenith;
  };
  return 0.1 * linear_srgb(value(x_), value(y_), std::max(value(luminance_), 0.0));
}

glm::dvec3 SkyModel::radiance(const glm::dvec3& direction) const {
  if (direction.y <= -haze) return ground_;
  const double part = glm::smoothstep(0.0, haze, -direction.y);
  return glm::mix(above(direction), ground_, part);
}

}  // namespace coppice
