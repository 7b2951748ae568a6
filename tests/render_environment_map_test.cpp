// Environments as the stages take them: what the map shows in each direction, and that directions are sampled
// as their density says.
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>

#include "render/environment_map.h"
#include "scene/random.h"
#include "support/environment_images.h"
#include "twins/environment.h"
#include "twins/sampler.h"

namespace coppice {
namespace {

constexpr double pi = std::numbers::pi;

twins::Surroundings address_of(const std::vector<Surrounding>& all) {
  return {reinterpret_cast<std::uint64_t>(all.data())};
}

twins::EnvironmentLight seen(const std::vector<Surrounding>& all, const glm::dvec3& direction) {
  return twins::environment_in(address_of(all), vec3(direction));
}

RadianceImage spotted_image() {
  RadianceImage image = even_image({0.1f, 0.1f, 0.1f});
  add_spot(image, glm::normalize(glm::dvec3(0.5, 1, -0.7)), vec3(50));
  add_spot(image, glm::normalize(glm::dvec3(-0.5, -0.4, 0.7)), {20, 5, 0}, 4);
  return image;
}

// Evenly over the sphere.
glm::dvec3 direction_at(int i, int count) {
  const double y = 1 - 2 * (i + 0.5) / count, turn = i * pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - y * y);
  return {r * std::cos(turn), y, r * std::sin(turn)};
}

TEST(EnvironmentMap, TexelsCoverTheSphereAndEachItsPart) {
  for (const std::uint32_t side : {16u, 64u}) {
    const TexelSolidAngles solid_angles(side);
    double all = 0;
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) all += solid_angles.at(x, y);
    }
    EXPECT_NEAR(all, 4 * pi, 1e-10);
  }
  // By the formula of the density: |p|^-3 for each unit of area, of the middle of small texels.
  const TexelSolidAngles small(1024);
  EXPECT_NEAR(small.at(512, 512) / (4.0 / 1024 / 1024), 1, 0.01);
  EXPECT_NEAR(small.at(256, 255) / (4.0 / 1024 / 1024), std::pow(0.5, -1.5), 0.02);
}

TEST(EnvironmentMap, ShowsEachDirectionWhatTheImageHasThere) {
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1),
                                glm::dvec3(0, 0, -1), glm::normalize(glm::dvec3(3, 2, -1))}) {
    RadianceImage image = even_image(vec3(0), 256, 128);
    add_spot(image, axis, {1, 0, 0}, 6);
    const auto all = surroundings(vec3(0), environment_map(image, 0, 1), 1);
    EXPECT_EQ(all[0].end, 256u);
    EXPECT_NEAR(seen(all, axis).radiance.x, 1, 0.05) << axis.x << " " << axis.y << " " << axis.z;
    EXPECT_EQ(seen(all, axis).radiance.y, 0);
    EXPECT_EQ(seen(all, -axis).radiance.x, 0);
  }
  RadianceImage image = even_image(vec3(0), 64, 32);
  std::fill_n(image.pixels.begin(), 64, vec3(0, 2, 0));     // the upper row
  std::fill_n(image.pixels.end() - 64, 64, vec3(0, 0, 3));  // the lower one
  const auto all = surroundings(vec3(0), environment_map(image, 0, 1), 1);
  EXPECT_NEAR(seen(all, {0, 1, 0}).radiance.y, 2, 0.2);
  EXPECT_NEAR(seen(all, {0, -1, 0}).radiance.z, 3, 0.3);
}

TEST(EnvironmentMap, IsTheImageWhereItIsSmooth) {
  RadianceImage image = even_image(vec3(0), 128, 64);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 128; ++x) {
      const glm::dvec3 d = direction_of_pixel(image, x, y);
      image.pixels[128 * y + x] = vec3(2.0 + d);
    }
  }
  const auto all = surroundings(vec3(0), environment_map(image, 0, 1), 1);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 d = direction_at(i, 1000);
    const vec3 radiance = seen(all, d).radiance;
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(radiance[channel], 2 + d[channel], 0.01);
  }
}

TEST(EnvironmentMap, TurnsCounterclockwiseAroundTheUpwardAxisAndTakesAnIntensity) {
  RadianceImage image = even_image(vec3(0), 256, 128);
  add_spot(image, {1, 0, 0}, vec3(1), 6);
  const std::array<glm::dvec3, 4> quarters = {{{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}}};
  for (int turns = -4; turns <= 4; ++turns) {
    const auto all = surroundings(vec3(0), environment_map(image, static_cast<float>(90 * turns), 2.5f), 1);
    for (int i = 0; i < 4; ++i) {
      const bool there = (turns + 4) % 4 == i;
      EXPECT_NEAR(seen(all, quarters[static_cast<std::size_t>(i)]).radiance.x, there ? 2.5 : 0, 0.1) << turns;
    }
  }
}

TEST(EnvironmentMap, HasThePowerOfTheImage) {
  for (const auto& [width, height] : {std::pair{64u, 32u}, std::pair{37u, 11u}, std::pair{1u, 1u}}) {
    RadianceImage image = even_image(vec3(0), width, height);
    Random random(7);
    for (glm::vec3& pixel : image.pixels)
      pixel = vec3(random.uniform() < 0.01f ? 100 : 1, random.uniform(), 0);
    const EnvironmentMap map = environment_map(image, 30, 1);
    const TexelSolidAngles solid_angles(map.side);
    glm::dvec3 power(0), wanted(0);
    for (std::uint32_t y = 0; y < map.side; ++y) {
      for (std::uint32_t x = 0; x < map.side; ++x)
        power += glm::dvec3(map.radiance[std::size_t{map.side} * y + x]) * solid_angles.at(x, y);
    }
    for (std::uint32_t y = 0; y < height; ++y) {
      const double zone = std::cos(pi * y / height) - std::cos(pi * (y + 1) / height);
      for (std::uint32_t x = 0; x < width; ++x)
        wanted += glm::dvec3(image.pixels[std::size_t{width} * y + x]) * (zone * 2 * pi / width);
    }
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(power[channel], wanted[channel], 1e-5 * wanted[channel]) << width;
  }
}

TEST(EnvironmentMap, AnEvenImageIsEven) {
  for (const vec3& radiance : environment_map(even_image({0.25f, 1, 3}, 50, 20), 12, 2).radiance) {
    EXPECT_NEAR(radiance.x, 0.5, 1e-6);
    EXPECT_NEAR(radiance.y, 2, 1e-6);
    EXPECT_NEAR(radiance.z, 6, 1e-5);
  }
}

TEST(EnvironmentMap, ItsDensityIntegratesToTheChanceOfTheEnvironment) {
  const auto all = surroundings(vec3(0), environment_map(spotted_image(), 0, 1), 0.75f);
  constexpr int count = 1 << 20;
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += seen(all, direction_at(i, count)).density;
  EXPECT_NEAR(sum * 4 * pi / count, 0.75, 0.002);
}

// Each texel by its solid angle: where the map is 16 a side, that of its density is the share in it.
TEST(EnvironmentMap, DirectionsComeAsOftenAsTheirDensitySays) {
  RadianceImage image = even_image(vec3(0.1f), 16, 8);
  add_spot(image, glm::normalize(glm::dvec3(1, 1, 1)), vec3(4));
  const auto all = surroundings(vec3(0), environment_map(image, 0, 1), 1);
  const uint side = all[0].end;
  ASSERT_EQ(side, 16u);
  constexpr uint count = 1 << 16;
  std::vector<double> often(side * side), wanted(side * side);
  for (uint i = 0; i < count; ++i) {
    const auto sample =
        twins::sample_environment(address_of(all), twins::sample_2d(1, i, 0), twins::sample_2d(1, i, 1));
    const vec3 p = sample.towards;
    EXPECT_NEAR(std::abs(p.x) + std::abs(p.y) + std::abs(p.z), 1, 1e-6);
    const float s = p.y < 0 ? (1 - std::abs(p.z)) * (p.x < 0 ? -1.0f : 1.0f) : p.x;
    const float t = p.y < 0 ? (1 - std::abs(p.x)) * (p.z < 0 ? -1.0f : 1.0f) : p.z;
    const auto column = std::min(static_cast<uint>((s + 1) * 8), 15u);
    const auto row = std::min(static_cast<uint>((t + 1) * 8), 15u);
    often[side * row + column] += 1.0 / count;
  }
  // Integrated over each texel.
  double all_wanted = 0, worst = 0;
  for (uint row = 0; row < side; ++row) {
    for (uint column = 0; column < side; ++column) {
      double sum = 0;
      for (int k = 0; k < 64; ++k) {
        const double s = (column + (k % 8 + 0.5) / 8) / 8 - 1, t = (row + (k / 8 + 0.5) / 8) / 8 - 1;
        glm::dvec3 p(s, 1 - std::abs(s) - std::abs(t), t);
        if (p.y < 0) p = {std::copysign(1 - std::abs(t), s), p.y, std::copysign(1 - std::abs(s), t)};
        sum += seen(all, p).density * std::pow(glm::length(p), -3) / 64 / 64;
      }
      all_wanted += sum;
      worst = std::max(worst, std::abs(often[side * row + column] - sum));
      EXPECT_NEAR(often[side * row + column], sum, 4 * std::sqrt(sum / count) + 1e-5);
    }
  }
  EXPECT_NEAR(all_wanted, 1, 1e-5);
  EXPECT_LT(worst, 0.01);
}

TEST(EnvironmentMap, WhatIsSampledIsWhatIsMetThere) {
  const auto all = surroundings(vec3(0), environment_map(spotted_image(), 0, 1), 0.5f);
  int other_texel = 0;
  for (uint i = 0; i < 4096; ++i) {
    const auto sample =
        twins::sample_environment(address_of(all), twins::sample_2d(3, i, 0), twins::sample_2d(3, i, 1));
    EXPECT_GT(sample.light.density, 0);
    const auto met = twins::environment_in(address_of(all), sample.towards);
    // Next to the border between two texels rounding may tell them apart otherwise.
    const bool same = std::abs(met.density - sample.light.density) <= 1e-5f * sample.light.density;
    other_texel += !same;
    EXPECT_NEAR(met.radiance.x, sample.light.radiance.x, 1e-3 * sample.light.radiance.x);
  }
  EXPECT_LE(other_texel, 4);
}

TEST(EnvironmentMap, SamplesHaveTheIrradianceOfTheImage) {
  const RadianceImage image = spotted_image();
  const auto all = surroundings(vec3(0), environment_map(image, 0, 1), 1);
  constexpr uint count = 1 << 16;
  double sum = 0;
  for (uint i = 0; i < count; ++i) {
    const auto sample =
        twins::sample_environment(address_of(all), twins::sample_2d(5, i, 0), twins::sample_2d(5, i, 1));
    const double cosine = sample.towards.y / glm::length(glm::dvec3(sample.towards));
    sum += std::max(cosine, 0.0) * sample.light.radiance.x / sample.light.density / count;
  }
  const double wanted = irradiance_from_above(image).x;
  EXPECT_NEAR(sum, wanted, 0.01 * wanted);
}

TEST(EnvironmentMap, WhatIsBlackIsNeverChosen) {
  RadianceImage image = even_image(vec3(0));
  add_spot(image, {0, 0, -1}, vec3(1), 4);
  const EnvironmentMap map = environment_map(image, 0, 1);
  EXPECT_TRUE(is_bright(map));
  const auto all = surroundings(vec3(0), map, 1);
  for (uint i = 0; i < 4096; ++i) {
    const auto sample =
        twins::sample_environment(address_of(all), twins::sample_2d(2, i, 0), twins::sample_2d(2, i, 1));
    EXPECT_LT(sample.towards.z, -0.5f);
  }
  EXPECT_FALSE(is_bright(environment_map(even_image(vec3(0)), 0, 1)));
  EXPECT_EQ(surroundings(vec3(3), {}, 0).size(), 1u);
  EXPECT_EQ(surroundings(vec3(3), {}, 0)[0].radiance, vec3(3));
}

TEST(EnvironmentMap, HasAsManyTexelsAsTheImagePixelsWithinItsBounds) {
  const auto side_of = [](std::uint32_t width, std::uint32_t height) {
    return environment_map(even_image(vec3(1), width, height), 0, 1).side;
  };
  EXPECT_EQ(side_of(1, 1), 16u);
  EXPECT_EQ(side_of(32, 8), 16u);
  EXPECT_EQ(side_of(33, 8), 32u);
  EXPECT_EQ(side_of(256, 128), 256u);
}

// --- Skies.

double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// The paper's formula of the zenith, worked out by hand for turbidity 3 and a sun at 45 degrees.
TEST(SkyModel, HasTheZenithOfThePaper) {
  const Sky sky{.sun = glm::normalize(glm::vec3(1, 1, 0)), .turbidity = 3};
  EXPECT_NEAR(luminance(SkyModel(sky).radiance({0, 1, 0})), 0.1 * 7.317, 0.001);
}

TEST(SkyModel, IsBrightestAtTheSunBlueAcrossFromItAndTheSameOnBothSides) {
  const Sky sky{.sun = glm::normalize(glm::vec3(0, 0.5f, -1)), .turbidity = 2.5f};
  const SkyModel model(sky);
  const glm::dvec3 at_sun = model.radiance(glm::normalize(glm::dvec3(sky.sun)));
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 d = direction_at(i, 1000);
    const glm::dvec3 radiance = model.radiance(d), mirrored = model.radiance({-d.x, d.y, d.z});
    EXPECT_LE(luminance(radiance), luminance(at_sun));
    EXPECT_NEAR(glm::length(radiance - mirrored), 0, 1e-9);
    for (int channel = 0; channel < 3; ++channel) EXPECT_GE(radiance[channel], 0);
  }
  const glm::dvec3 away = model.radiance(glm::normalize(glm::dvec3(0, 1, 0.6)));
  EXPECT_GT(away.z, 1.5 * away.x);
}

TEST(SkyModel, GroundReflectsTheIrradianceOfTheSky) {
  const Sky sky{.ground = 0.5f};
  const SkyModel model(sky);
  glm::dvec3 irradiance(0);
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 d = direction_at(i, count);
    if (d.y > 0) irradiance += model.radiance(d) * d.y * (4 * pi / count);
  }
  const glm::dvec3 ground = model.radiance({0, -1, 0});
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(ground[channel], 0.5 * irradiance[channel] / pi, 0.005 * ground[channel]);
}

TEST(SkyModel, IsFiniteWhereverTheSunIsAndHoweverHazy) {
  for (const float turbidity : {2.0f, 5.0f, 10.0f}) {
    for (const float height : {0.0f, 0.01f, 0.5f, 1.0f}) {
      const Sky sky{.sun = glm::vec3(std::sqrt(1 - height * height), height, 0), .turbidity = turbidity};
      const SkyModel model(sky);
      for (int i = 0; i < 500; ++i) {
        const glm::dvec3 radiance = model.radiance(direction_at(i, 500));
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_TRUE(std::isfinite(radiance[channel])) << turbidity << " " << height;
          EXPECT_LT(radiance[channel], 100);
        }
      }
    }
  }
}

}  // namespace
}  // namespace coppice
