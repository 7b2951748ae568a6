#include "render/environment_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "render/stage_values.h"

namespace coppice {

namespace {

constexpr double pi = std::numbers::pi;

double with_sign_of(double size, double sign) { return sign < 0 ? -size : size; }

// On the octahedron, of a place of the square in texels.
glm::dvec3 octahedron_place(double x, double y, std::uint32_t side) {
  const double s = 2 * x / side - 1, t = 2 * y / side - 1, up = 1 - std::abs(s) - std::abs(t);
  if (up >= 0) return {s, up, t};
  return {with_sign_of(1 - std::abs(t), s), up, with_sign_of(1 - std::abs(s), t)};
}

// The mean of `radiance`, a function of unit directions, over each texel: points^2 samples, by solid angle.
template <class Radiance>
std::vector<glm::dvec3> means_over_texels(std::uint32_t side, int points, const Radiance& radiance) {
  std::vector<glm::dvec3> means(std::size_t{side} * side);
  tbb::parallel_for(std::uint32_t{0}, side, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      glm::dvec3 sum(0);
      double weights = 0;
      for (int k = 0; k < points * points; ++k) {
        const glm::dvec3 place =
            octahedron_place(x + (k % points + 0.5) / points, y + (k / points + 0.5) / points, side);
        const double squared = glm::dot(place, place), length = std::sqrt(squared);
        const double weight = 1 / (squared * length);
        sum += radiance(place / length) * weight;
        weights += weight;
      }
      means[std::size_t{side} * y + x] = sum / weights;
    }
  });
  return means;
}

EnvironmentMap map_of(std::uint32_t side, const std::vector<glm::dvec3>& means, const glm::dvec3& factor) {
  EnvironmentMap map{side, {}};
  map.radiance.reserve(means.size());
  for (const glm::dvec3& mean : means)
    map.radiance.push_back(
        flush_to_zero(vec3(glm::clamp(mean * factor, glm::dvec3(0), glm::dvec3(MAX_RADIANCE)))));
  return map;
}

// An equirectangular image by direction.
class Equirectangular {
 public:
  Equirectangular(const RadianceImage& image, float rotation_degrees)
      : image_(image), turn_(rotation_degrees / 360.0) {}

  // Bilinear.
  glm::dvec3 operator()(const glm::dvec3& direction) const {
    const double across = 0.5 + std::atan2(direction.x, -direction.z) / (2 * pi) + turn_;
    const double down = std::atan2(std::hypot(direction.x, direction.z), direction.y) / pi;
    const double x = (across - std::floor(across)) * image_.width - 0.5, y = down * image_.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(top);
    return glm::mix(glm::mix(pixel(column, row), pixel(column + 1, row), x - left),
                    glm::mix(pixel(column, row + 1), pixel(column + 1, row + 1), x - left), y - top);
  }

  // Radiance times solid angle, of all pixels.
  glm::dvec3 power() const {
    glm::dvec3 sum(0);
    for (std::uint32_t y = 0; y < image_.height; ++y) {
      const double zone = std::cos(pi * y / image_.height) - std::cos(pi * (y + 1) / image_.height);
      glm::dvec3 row(0);
      for (std::uint32_t x = 0; x < image_.width; ++x) row += pixel(x, y);
      sum += row * (zone * 2 * pi / image_.width);
    }
    return sum;
  }

 private:
  glm::dvec3 pixel(std::int64_t column, std::int64_t row) const {
    const auto width = static_cast<std::int64_t>(image_.width);
    row = std::clamp<std::int64_t>(row, 0, static_cast<std::int64_t>(image_.height) - 1);
    return glm::dvec3(image_.pixels[static_cast<std::size_t>(row * width + (column + width) % width)]);
  }

  const RadianceImage& image_;
  double turn_;
};

// Solid angle of a triangle: van Oosterom and Strackee 1983.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

double luminance_of(const vec3& colour) { return 0.2126 * colour.x + 0.7152 * colour.y + 0.0722 * colour.z; }

}  // namespace

TexelSolidAngles::TexelSolidAngles(std::uint32_t side)
    : half_(side / 2), quarter_(std::size_t{half_} * half_) {
  tbb::parallel_for(std::uint32_t{0}, half_, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < half_; ++x) {
      const glm::dvec3 a = octahedron_place(x, y, side), b = octahedron_place(x + 1.0, y, side),
                       c = octahedron_place(x, y + 1.0, side), d = octahedron_place(x + 1.0, y + 1.0, side);
      // Along the fold, which passes through corners of texels.
      quarter_[std::size_t{half_} * y + x] = solid_angle(a, b, c) + solid_angle(b, d, c);
    }
  });
}

EnvironmentMap environment_map(const RadianceImage& image, float rotation_degrees, float intensity) {
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  std::uint32_t side = ENVIRONMENT_LEAST_SIDE;
  while (side < ENVIRONMENT_MOST_SIDE && std::uint64_t{side} * side < pixels) side *= 2;
  const double a_side = std::sqrt(static_cast<double>(pixels));
  const int points = std::max(2, static_cast<int>(std::ceil(2 * a_side / side)));
  const Equirectangular radiance(image, rotation_degrees);
  const std::vector<glm::dvec3> means = means_over_texels(side, points, radiance);
  const TexelSolidAngles solid_angles(side);
  glm::dvec3 power(0);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x)
      power += means[std::size_t{side} * y + x] * solid_angles.at(x, y);
  }
  glm::dvec3 factor(intensity);
  const glm::dvec3 wanted = radiance.power();
  for (int channel = 0; channel < 3; ++channel) {
    if (power[channel] > 0) factor[channel] *= wanted[channel] / power[channel];
  }
  return map_of(side, means, factor);
}

EnvironmentMap environment_map(const Environment& environment, std::string& warning) {
  if (!environment.sky)
    return environment_map(load_radiance(environment, warning), environment.rotation_degrees,
                           environment.intensity);
  const SkyModel sky(*environment.sky);
  const auto radiance = [&](const glm::dvec3& direction) { return sky.radiance(direction); };
  return map_of(SKY_SIDE, means_over_texels(SKY_SIDE, 4, radiance), glm::dvec3(environment.intensity));
}

bool is_bright(const EnvironmentMap& map) {
  return std::ranges::any_of(map.radiance, [](const vec3& r) { return luminance_of(r) > 0; });
}

namespace {

// Luminance at a texel, also one texel beyond the edges.
class Luminances {
 public:
  explicit Luminances(const EnvironmentMap& map) : side_(static_cast<int>(map.side)) {
    for (const vec3& r : map.radiance) at_.push_back(luminance_of(r));
  }

  // The mean of what is bilinear between centres, over a texel.
  double mean_over(int x, int y) const {
    constexpr double near[] = {0.125, 0.75, 0.125};
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) sum += near[i] * near[j] * at(x + i - 1, y + j - 1);
    }
    return sum;
  }

 private:
  double at(int x, int y) const {
    const int last = side_ - 1;
    if (x < 0 || x > last) y = last - y;
    x = std::clamp(x, 0, last);
    if (y < 0 || y > last) x = last - x;
    y = std::clamp(y, 0, last);
    return at_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x)];
  }

  int side_;
  std::vector<double> at_;
};

// The ends of shares of ENVIRONMENT_RANGE by weight, each that is positive at least 1; 0 where none is.
std::vector<uint> ends_of(std::span<const double> weights) {
  double all = 0;
  uint count = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    all += weights[i];
    ++count;
    last = i;
  }
  std::vector<uint> ends(weights.size(), 0);
  double until = 0;
  uint so_far = 0;
  for (std::size_t i = 0; count > 0 && i < weights.size(); ++i) {
    if (weights[i] > 0) {
      until += weights[i];
      ++so_far;
    }
    const double part = std::min(until / all, 1.0);
    ends[i] = i >= last ? ENVIRONMENT_RANGE : static_cast<uint>(part * (ENVIRONMENT_RANGE - count)) + so_far;
  }
  return ends;
}

}  // namespace

std::vector<Surrounding> surroundings(vec3 ambient, const EnvironmentMap& map, float probability) {
  std::vector<Surrounding> all{{ambient, map.side}};
  if (map.side == 0) return all;
  const std::size_t side = map.side;
  all.resize(1 + side * (side + 1));
  const Luminances luminances(map);
  const TexelSolidAngles solid_angles(map.side);
  std::vector<double> row_weights(side);
  tbb::parallel_for(std::size_t{0}, side, [&](std::size_t y) {
    std::vector<double> weights(side);
    for (std::size_t x = 0; x < side; ++x) {
      weights[x] = luminances.mean_over(static_cast<int>(x), static_cast<int>(y)) *
                   solid_angles.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      row_weights[y] += weights[x];
    }
    const std::vector<uint> ends = ends_of(weights);
    for (std::size_t x = 0; x < side; ++x) all[1 + side * y + x] = {map.radiance[side * y + x], ends[x]};
  });
  const std::vector<uint> ends = ends_of(row_weights);
  const float texels = static_cast<float>(side * side) / 4 / ENVIRONMENT_RANGE / ENVIRONMENT_RANGE;  // exact
  for (std::size_t y = 0; y < side; ++y) {
    const auto share = static_cast<float>(ends[y] - (y == 0 ? 0 : ends[y - 1]));
    all[1 + side * side + y] = {vec3(probability * share * texels, 0, 0), ends[y]};
  }
  return all;
}

}  // namespace coppice
