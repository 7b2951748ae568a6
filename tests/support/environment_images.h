#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <numbers>
#include <string>

#include "scene/environment.h"

namespace coppice {

inline RadianceImage even_image(glm::vec3 radiance, std::uint32_t width = 64, std::uint32_t height = 32) {
  return {width, height, std::vector<glm::vec3>(std::size_t{width} * height, radiance)};
}

// A square of `pixels` a side, whose middle is seen in that direction, of unit length.
inline void add_spot(RadianceImage& image, glm::dvec3 direction, glm::vec3 radiance, int pixels = 2) {
  const double across = 0.5 + std::atan2(direction.x, -direction.z) / (2 * std::numbers::pi);
  const double down = std::acos(direction.y) / std::numbers::pi;
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  const int left = static_cast<int>(std::lround(across * width)) - pixels / 2;
  const int top = static_cast<int>(std::lround(down * height)) - pixels / 2;
  for (int y = std::max(top, 0); y < std::min(top + pixels, height); ++y) {
    for (int x = left; x < left + pixels; ++x)
      image.pixels[static_cast<std::size_t>(y * width + (x + width) % width)] = radiance;
  }
}

// Of the direction through the middle of a pixel.
inline glm::dvec3 direction_of_pixel(const RadianceImage& image, double x, double y) {
  const double phi = 2 * std::numbers::pi * ((x + 0.5) / image.width - 0.5);
  const double theta = std::numbers::pi * (y + 0.5) / image.height;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

// Of a surface that faces +y, by the pixels: the cosine times the solid angle of each is integrated exactly.
inline glm::dvec3 irradiance_from_above(const RadianceImage& image) {
  glm::dvec3 sum(0);
  const auto squared_cosine = [&](double row) {
    const double cosine = std::cos(std::min(std::numbers::pi * row / image.height, std::numbers::pi / 2));
    return cosine * cosine;
  };
  for (std::uint32_t y = 0; y < image.height; ++y) {
    const double zone = (squared_cosine(y) - squared_cosine(y + 1.0)) / 2;
    for (std::uint32_t x = 0; x < image.width; ++x)
      sum += glm::dvec3(image.pixels[std::size_t{image.width} * y + x]) *
             (zone * 2 * std::numbers::pi / image.width);
  }
  return sum;
}

// Flat Radiance HDR: three mantissas and an exponent a pixel.
inline std::string hdr_of(std::uint32_t width, std::uint32_t height,
                          std::initializer_list<std::array<unsigned char, 4>> pixels) {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                      std::to_string(width) + "\n";
  for (const auto& pixel : pixels) bytes.append(pixel.begin(), pixel.end());
  return bytes;
}

}  // namespace coppice
