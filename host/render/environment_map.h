#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interface/environment.h"
#include "scene/environment.h"

namespace coppice {

// Radiance on the octahedral square of interface/environment.h: intensity and rotation are in it.
struct EnvironmentMap {
  std::uint32_t side = 0;      // a power of two
  std::vector<vec3> radiance;  // side * side, each the mean over its texel, from 0 to MAX_RADIANCE
};

// Of an image the least side whose texels are as many as its pixels, from ENVIRONMENT_LEAST_SIDE to
// ENVIRONMENT_MOST_SIDE; of a sky SKY_SIDE. An image that is missing or broken is said in `warning`.
EnvironmentMap environment_map(const Environment& environment, std::string& warning);

// The same of an image in hand, as equirectangular: its middle is seen along -z, its right half towards +x,
// its upper edge along +y, and all of it is then turned by that angle about +y. Each channel has the power
// of the image: what the mean of samples misses of that is made up for by a factor over all texels.
EnvironmentMap environment_map(const RadianceImage& image, float rotation_degrees, float intensity);

inline constexpr std::uint32_t SKY_SIDE = 512;

// As the stages take it: shares by luminance times solid angle, of what bilinear radiance there is in a
// texel, so that whatever is not black is found. Without a map (side 0) ambient light alone.
// `probability`: that the environment is chosen among the lights.
std::vector<Surrounding> surroundings(vec3 ambient, const EnvironmentMap& map, float probability);

// Whether there is light in it.
bool is_bright(const EnvironmentMap& map);

// Of each texel, exactly: by the two triangles that a diagonal cuts it into.
class TexelSolidAngles {
 public:
  explicit TexelSolidAngles(std::uint32_t side);
  double at(std::uint32_t x, std::uint32_t y) const {
    const auto mirrored = [&](std::uint32_t i) { return i < half_ ? i : 2 * half_ - 1 - i; };
    return quarter_[std::size_t{half_} * mirrored(y) + mirrored(x)];
  }

 private:
  std::uint32_t half_;
  std::vector<double> quarter_;  // of the square, whose other quarters are the same mirrored
};

}  // namespace coppice
