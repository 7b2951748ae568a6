// The twin of the textures' kernel library against closed forms; the kernel has its bits
// (device_texture_test).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/texture.h"
#include "twins/texture.h"

namespace coppice {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity(), NONE = std::numeric_limits<float>::quiet_NaN();

// A texture of numbers alone, at level 0, in texels a, b, ... of the red channel.
class TwinTexture {
 public:
  TwinTexture(uint width, uint height, std::vector<uint> texels, uint levels = 1, uint flags = 0)
      : texels_(std::move(texels)), linear_(srgb_to_linear()) {
    texels_.insert(texels_.begin(), 7, 0xffffffff);  // before it, never read
    header_ = {7, width, height, levels, vec2(1), vec2(0), flags, 0, 0, 0};
  }
  glm::vec4 at(vec2 uv, float level = 0) const {
    const auto address = [](const auto* from) { return reinterpret_cast<std::uint64_t>(from); };
    return twins::texture_colour({address(&header_)}, {address(texels_.data())}, {address(linear_.data())}, 0,
                                 uv, level);
  }
  TextureHeader& header() { return header_; }

 private:
  std::vector<uint> texels_;
  std::array<float, 256> linear_;
  TextureHeader header_{};
};

TEST(TextureTwin, MiddlesOfTexelsHaveTheirColours) {
  const TwinTexture texture(3, 2, {0, 51, 102, 153, 204, 255});
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const float at = static_cast<float>(3 * y + x) / 5;
      EXPECT_NEAR(texture.at({(static_cast<float>(x) + 0.5f) / 3, (static_cast<float>(y) + 0.5f) / 2}).x, at,
                  1e-6);
    }
  }
}

TEST(TextureTwin, IsBilinearBetweenThem) {
  const TwinTexture texture(2, 2, {0, 255, 0, 0x00ff00ff});
  EXPECT_NEAR(texture.at({0.5f, 0.25f}).x, 0.5, 1e-6);
  EXPECT_NEAR(texture.at({0.375f, 0.5f}).x, 0.25, 1e-6);
  EXPECT_NEAR(texture.at({0.625f, 0.625f}).z, 0.75 * 0.75, 1e-6);
}

TEST(TextureTwin, WrapModes) {
  const std::vector<uint> texels = {0, 85, 170, 255};
  const auto red = [&](float u, uint wrap) { return TwinTexture(4, 1, texels, 1, wrap).at({u, 0.5f}).x; };
  for (const float period : {-8.0f, -1.0f, 1.0f, 64.0f}) {
    EXPECT_EQ(red(0.375f + period, TEXTURE_REPEAT), red(0.375f, TEXTURE_REPEAT));
    EXPECT_EQ(red(0.375f + 2 * period, TEXTURE_MIRROR), red(0.375f, TEXTURE_REPEAT));
    EXPECT_EQ(red(-0.375f + 2 * period, TEXTURE_MIRROR), red(0.375f, TEXTURE_REPEAT));
  }
  EXPECT_EQ(red(0, TEXTURE_REPEAT), 0.5f * red(0.875f, TEXTURE_REPEAT));  // between the last and the first
  EXPECT_EQ(red(0, TEXTURE_MIRROR), 0);
  EXPECT_EQ(red(-7, TEXTURE_CLAMP), 0);
  EXPECT_NEAR(red(7, TEXTURE_CLAMP), 1, 1e-6);
  EXPECT_NEAR(red(1, TEXTURE_MIRROR), 1, 1e-6);
}

TEST(TextureTwin, NoPlaceReadsOutside) {
  for (uint wrap : {TEXTURE_REPEAT, TEXTURE_CLAMP, TEXTURE_MIRROR}) {
    TwinTexture texture(3, 5, std::vector<uint>(15 + 2 + 1, 0), 3, wrap | wrap << TEXTURE_WRAP_V_SHIFT);
    for (const float place :
         {NONE, INF, -INF, 3e38f, -3e38f, 8388607.5f, -1e-39f, -1e-18f, 1.0f, 0.99999994f}) {
      for (const float level : {0.0f, 0.5f, 2.0f, 99.0f, -1.0f, NONE, INF}) {
        EXPECT_EQ(texture.at({place, 0.3f}, level), glm::vec4(0)) << place << " " << level;
        EXPECT_EQ(texture.at({0.3f, place}, level), glm::vec4(0)) << place << " " << level;
      }
    }
  }
}

TEST(TextureTwin, LevelsAndScales) {
  TwinTexture texture(2, 1, {0, 0, 255}, 2);
  EXPECT_EQ(texture.at({0.3f, 0}, 0).x, 0);
  EXPECT_NEAR(texture.at({0.3f, 0}, 0.25f).x, 0.25, 1e-6);
  EXPECT_NEAR(texture.at({0.3f, 0}, 1).x, 1, 1e-6);
  EXPECT_NEAR(texture.at({0.3f, 0}, 9).x, 1, 1e-6);
  TwinTexture turned(1, 2, {0, 255});
  turned.header().scale = {1, -1};
  turned.header().offset = {0, 1};
  EXPECT_NEAR(turned.at({0, 0.25f}).x, 1, 1e-6);  // the lower half
}

TEST(TextureTwin, ColoursAreLinearAndAlphaIsNot) {
  const TwinTexture texture(1, 1, {0x80bc0080}, 1, TEXTURE_COLOUR);
  const glm::vec4 colour = texture.at({0, 0});
  EXPECT_NEAR(colour.x, 0.2158605, 1e-6);  // 128
  EXPECT_EQ(colour.y, 0);
  EXPECT_NEAR(colour.z, 0.5028865, 1e-6);  // 188
  EXPECT_NEAR(colour.w, 128.0 / 255, 1e-6);
}

TEST(TextureTwin, Log2IsNear) {
  double worst = 0;
  for (float x = 1e-30f; x < 1e30f; x *= 1.0001f)
    worst = std::max(worst, std::abs(twins::log2_by_bits(x) - std::log2(double{x})));
  EXPECT_LT(worst, 0.00015);
  EXPECT_EQ(twins::log2_by_bits(1), 0);
  EXPECT_EQ(twins::log2_by_bits(1024), 10);
  for (const float x : {0.0f, -0.0f, -1.0f, 1e-39f, NONE, -INF}) EXPECT_EQ(twins::log2_by_bits(x), -126);
  EXPECT_EQ(twins::log2_by_bits(INF), 128);
}

// A square metre with a texture of 256 texels a side, seen by cones of some widths.
TEST(TextureTwin, LevelsAreThoseOfTheFootprint) {
  const Triangle triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CornerAttributes corners{};
  corners.texcoord_b = {1, 0};
  corners.texcoord_c = {0, 1};
  TextureHeader header{};
  header.width = header.height = 256;
  header.scale = {1, -1};
  const auto level = [&](float width, float cosine) {
    return twins::surface_level(twins::twice_texcoord_area(corners), twins::twice_area(triangle), width,
                                cosine) +
           twins::texture_level(header);
  };
  EXPECT_EQ(level(1.0f / 256, 1), 0);  // a texel wide
  EXPECT_EQ(level(4.0f / 256, 1), 2);
  EXPECT_EQ(level(1.0f / 256, 0.5f), 1);  // twice as long on the surface
  EXPECT_EQ(level(1, 1), 8);
  EXPECT_NEAR(level(3.0f / 256, 1), std::log2(3.0), 0.0002);
  header.scale = {2, 2};
  EXPECT_EQ(level(1.0f / 256, 1), 1);
  EXPECT_EQ(twins::cone_width_at(0.5f, 0.25f, 8), 2.5f);
}

TEST(TextureTwin, AreasOfAnySize) {
  for (const float scale : {1e-12f, 1.0f, 1e9f}) {
    const Triangle triangle{{0, 0, scale}, {3 * scale, 0, scale}, {0, 4 * scale, scale}};
    EXPECT_NEAR(twins::twice_area(triangle) / (12.0 * scale * scale), 1, 1e-5);
  }
  EXPECT_EQ(twins::twice_area({{1, 1, 1}, {1, 1, 1}, {2, 2, 2}}), 0);
  EXPECT_EQ(twins::twice_area({{NONE, 1, 1}, {1, 1, 1}, {2, 2, 2}}), INF);
  EXPECT_EQ(twins::twice_area({{0, 0, 0}, {3e38f, 0, 0}, {0, 3e38f, 0}}), INF);
}

}  // namespace
}  // namespace coppice
