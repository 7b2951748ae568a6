#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

// A clear or hazy sky by day, of Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight",
// over even ground that reflects it. The sun's disk is not part of it.
struct Sky {
  glm::vec3 sun{0.426401f, 0.852803f, 0.301511f};  // unit length, towards it; y is not negative
  float turbidity = 3;                             // 2 (very clear) to 10 (hazy)
  float ground = 0.2f;                             // albedo, 0 to 1
};

// Light from everywhere, infinitely far away. Nothing of an image is opened here.
struct Environment {
  std::string image;           // as the scene file writes it; empty: the sky
  std::string folder;          // where its name leads on from
  std::optional<Sky> sky;      // there is an image or this
  float intensity = 1;         // by which radiance is multiplied; not negative
  float rotation_degrees = 0;  // of an image, counterclockwise as seen from +y
  std::string origin;          // what the file calls it
};

// Linear RGB, rows from the top.
struct RadianceImage {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec3> pixels;  // each from 0 to MAX_RADIANCE
};

inline constexpr float MAX_RADIANCE = 0x1p60f;
inline constexpr std::uint32_t MAX_RADIANCE_SIDE = 16384;

// Of the bytes of a Radiance HDR or an OpenEXR file. What is negative or no number is 0. Throws InputError,
// with what is wrong and not where.
RadianceImage decode_radiance(std::string_view bytes);

// The two that it chooses from; of 1 to MAX_RADIANCE_SIDE pixels a side, any floats.
RadianceImage decode_radiance_hdr(std::string_view bytes);
RadianceImage decode_radiance_exr(std::string_view bytes);

// The image of an environment; squares of magenta and black and a line in `warning` where there is none. A
// file is also found in other letter case and so on, as those of textures are.
RadianceImage load_radiance(const Environment& environment, std::string& warning);

// Radiance of a sky, linear RGB; 1 is 10,000 candela per square metre.
class SkyModel {
 public:
  explicit SkyModel(const Sky& sky);

  // From a direction of unit length. Below the horizon the sky goes over, within 3.5 degrees, into the
  // ground, which is evenly lit by it.
  glm::dvec3 radiance(const glm::dvec3& direction) const;

 private:
  struct Perez {
    std::array<double, 5> coefficients;  // A to E
    double at_zenith;                    // of the quantity
    double of_zenith;                    // of the distribution
    double at(double cosine, double angle_to_sun) const;
  };
  glm::dvec3 above(const glm::dvec3& direction) const;

  glm::dvec3 sun_;
  Perez luminance_, x_, y_;
  glm::dvec3 ground_{0.0};
};

}  // namespace coppice
