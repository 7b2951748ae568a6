// What surfaces reflect and transmit: densities and values against each other and against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scene/random.h"
#include "support/surface_points.h"
#include "twins/circle.h"

namespace coppice {
namespace {

using namespace twins;

struct Case {
  SurfacePoint surface;
  BsdfSwitches switches = {};
};

std::vector<Case> cases() {
  std::vector<Case> result;
  for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
    result.push_back({surface(roughness, 0.8f, 0)});
    result.push_back({surface(roughness, 0.5f, 0.04f)});
    result.push_back({surface(roughness, 0, 0.9f)});
    result.push_back({surface(roughness, 0.7f, 0.04f, 0.6f, 1 / 1.5f)});
    result.push_back({surface(roughness, 0.7f, 0.04f, 0.6f, 1.5f)});
    result.push_back({surface(roughness, 0.5f, 0.3f), {.diffuse_lobe = false}});
    result.push_back({surface(roughness, 0.5f, 0.3f), {.reflects = false}});
    result.push_back({surface(roughness, 0.5f, 0.3f, 0.5f), {.transmits = false}});
  }
  result.push_back({{some_normal(), 0.5f, vec3(0.9f, 0.1f, 0.3f), 1, vec3(0, 0.8f, 0.2f), 0}});
  return result;
}

constexpr double cosines[] = {1, 0.7, 0.15};

TEST(Bsdf, DensityIntegratesToOneAndSampledWeightsToTheValue) {
  const Directions directions(some_normal());
  int number = 0;
  for (const Case& each : cases()) {
    const SurfacePoint& s = each.surface;
    const BsdfSwitches& switches = each.switches;
    for (const double cosine : cosines) {
      SCOPED_TRACE("case " + std::to_string(number) + " at cosine " + std::to_string(cosine));
      const vec3 view = view_at(cosine);
      const Means means = means_of(s, view, 16384, switches);
      const auto pdf = [&](const vec3& light) { return bsdf_pdf(s, view, light, switches); };
      const auto value = [&](const vec3& light) {
        return bsdf_sampled(bsdf_terms(s, view, light, switches), switches);
      };
      // Lobes about the normal are narrow in cosines.
      const double density = integral_over<double>(directions, {-1, 0}, {0, 1}, {20, 50}, pdf) +
                             integral_over<double>(directions, {0, 0.95}, {0, 1}, {150, 600}, pdf) +
                             integral_over<double>(directions, {0.95, 1}, {0, 1}, {100, 100}, pdf);
      EXPECT_NEAR(density + means.delta + means.none, 1, 3e-3);
      const auto reflected = integral_over<glm::dvec3>(directions, {0, 0.95}, {0, 1}, {100, 600}, value) +
                             integral_over<glm::dvec3>(directions, {0.95, 1}, {0, 1}, {100, 50}, value);
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(means.with_density[channel], reflected[channel], 4e-3);
    }
    ++number;
  }
}

// Pearson's chi squared of sampled directions, in 8 by 16 parts of the hemisphere.
TEST(Bsdf, SampledDirectionsAreDistributedByTheDensity) {
  constexpr int rows = 8, columns = 16, samples = 40000;
  const Directions directions(some_normal());
  Random random(21);
  int number = 0;
  for (const Case& each : cases()) {
    const SurfacePoint& s = each.surface;
    const BsdfSwitches& switches = each.switches;
    SCOPED_TRACE("case " + std::to_string(number++));
    const vec3 view = view_at(0.6);
    std::vector<double> found(rows * columns, 0);
    for (int i = 0; i < samples; ++i) {
      const float lobe = random.uniform(), u = random.uniform(), v = random.uniform();
      const BsdfSample next = bsdf_sample(s, view, lobe, {u, v}, switches);
      if (!(next.pdf > 0)) continue;
      const glm::dvec2 at = directions.of(next.light);
      ++found[static_cast<std::size_t>(std::min(at.x * rows, rows - 1.0)) * columns +
              static_cast<std::size_t>(std::min(at.y * columns, columns - 1.0))];
    }
    double chi_squared = 0, expected_rest = 0, found_rest = 0;
    int parts = 0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double probability = integral_over<double>(
            directions, {row / 8.0, (row + 1) / 8.0}, {column / 16.0, (column + 1) / 16.0}, {40, 40},
            [&](const vec3& light) { return bsdf_pdf(s, view, light, switches); });
        const double expected = probability * samples;
        const double count = found[static_cast<std::size_t>(row * columns + column)];
        if (expected < 10) {
          expected_rest += expected;
          found_rest += count;
          continue;
        }
        chi_squared += (count - expected) * (count - expected) / expected;
        ++parts;
      }
    if (expected_rest > 10) chi_squared += std::pow(found_rest - expected_rest, 2) / expected_rest;
    EXPECT_NEAR(found_rest, expected_rest, 4 * std::sqrt(expected_rest) + 4);
    EXPECT_LT(chi_squared, parts + 1 + 4 * std::sqrt(2.0 * (parts + 1)));
  }
}

TEST(Bsdf, CosinesAndSinesAreOffByLessThan1EMinus7) {
  double most = 0;
  for (int i = -(1 << 16); i <= 1 << 16; ++i) {
    const float x = std::ldexp(static_cast<float>(i), -17);
    const OnCircle at = circle_beside_quarter(0, x);
    const double angle = static_cast<double>(x) * std::numbers::pi / 2;
    most = std::max({most, std::fabs(static_cast<double>(at.cos) - std::cos(angle)),
                     std::fabs(static_cast<double>(at.sin) - std::sin(angle))});
  }
  EXPECT_LT(most, 1e-7);
}

// Seen along the normal, where the density of lights is a quarter of the density of facets.
TEST(Bsdf, NarrowLobesKeepTheirDigits) {
  Random random(5);
  for (const double alpha : {0.00101, 0.01, 0.1, 1.0}) {
    const SurfacePoint s = surface(static_cast<float>(std::sqrt(alpha)), 0, 0.5f);
    const Directions directions(some_normal());
    for (int i = 0; i < 1000; ++i) {
      const double tangent = alpha * 2 * static_cast<double>(random.uniform());
      const double cosine = 1 / std::sqrt(1 + tangent * tangent);  // of the facet
      if (2 * cosine * cosine - 1 < 0.01) continue;
      const vec3 light = directions.at(2 * cosine * cosine - 1, 2);
      const double sine = tangent * cosine, a2 = alpha * alpha;
      const double facets = a2 / std::numbers::pi / std::pow(sine * sine + a2 * cosine * cosine, 2);
      EXPECT_NEAR(bsdf_pdf(s, some_normal(), light) / (facets / 4), 1, 5e-7 / alpha + 1e-5);
    }
  }
}

TEST(Bsdf, IsReciprocal) {
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    SurfacePoint s = surface(random.uniform(0.1f, 1), random.uniform(), random.uniform());
    if (i % 3 == 0) s.transmission = 0.5f, s.ior_ratio = i % 2 == 0 ? 0.7f : 1.4f;
    const Directions directions(s.normal);
    const double a = random.uniform(0.02f, 1), b = random.uniform(0.02f, 1), turn = random.uniform(0, 6);
    const vec3 first = directions.at(a, 0.3), second = directions.at(b, turn);
    const double there = static_cast<double>(bsdf_value(s, first, second).x) / b;
    const double back = static_cast<double>(bsdf_value(s, second, first).x) / a;
    EXPECT_NEAR(there, back, 1e-4 * std::max(there, back) + 1e-6);
    compared += there > 0;
  }
  EXPECT_GT(compared, 15000);
}

TEST(Bsdf, NoSurfaceGivesMoreLightThanItGets) {
  double most = 0;
  for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f})
    for (const float specular : {0.0f, 0.04f, 0.5f, 1.0f})
      for (const float transmission : {0.0f, 0.5f, 1.0f})
        for (const float ior_ratio : {1 / 1.5f, 1.0f, 1.5f})
          for (const double cosine : {1.0, 0.7, 0.4, 0.1, 0.02}) {
            const SurfacePoint s = surface(roughness, 1, specular, transmission, ior_ratio);
            const double furnace = means_of(s, view_at(cosine), 2048).all().x;
            EXPECT_LT(furnace, 1.004) << roughness << " " << specular << " " << transmission << " "
                                      << ior_ratio << " at " << cosine;
            most = std::max(most, furnace);
          }
  EXPECT_GT(most, 0.999);
}

TEST(Bsdf, WhiteDiffuseAndMirrorsKeepAllLightOfEachSample) {
  for (uint i = 0; i < 1000; ++i) {
    const vec3 view = view_at((i + 1) / 1000.0);
    const BsdfSample diffuse = bsdf_sample(surface(0.5f, 1, 0), view, sample_1d(1, i, 0), sample_2d(1, i, 1));
    EXPECT_EQ(diffuse.flags, BSDF_DIFFUSE);
    EXPECT_NEAR(diffuse.weight.y, 1, 1e-6);
    const BsdfSample mirror = bsdf_sample(surface(0, 0, 1), view, sample_1d(1, i, 0), sample_2d(1, i, 1));
    EXPECT_EQ(mirror.flags, BSDF_MIRROR);
    EXPECT_EQ(mirror.weight, vec3(1));
    EXPECT_EQ(mirror.pdf, 0);
    EXPECT_NEAR(dot_product(mirror.light, some_normal()), (i + 1) / 1000.0, 1e-6);
    EXPECT_NEAR(dot_product(mirror.light + view, some_normal()), 2 * (i + 1) / 1000.0, 2e-6);
  }
}

TEST(Bsdf, LobesThatAreNotCompiledAreAsIfTheSurfaceHadNone) {
  const SurfacePoint s = surface(0.5f, 0.6f, 0.3f, 0.4f, 1.5f);
  SurfacePoint without_specular = s, without_transmission = s;
  without_specular.specular = vec3(0);
  without_transmission.transmission = 0;
  const vec3 view = view_at(0.6), light = view_at(0.8);
  EXPECT_EQ(bsdf_value(s, view, light, {.reflects = false}), bsdf_value(without_specular, view, light));
  EXPECT_EQ(bsdf_pdf(s, view, light, {.reflects = false}), bsdf_pdf(without_specular, view, light));
  EXPECT_EQ(bsdf_value(s, view, light, {.transmits = false}), bsdf_value(without_transmission, view, light));
  EXPECT_EQ(bsdf_pdf(s, view, light, {.transmits = false}), bsdf_pdf(without_transmission, view, light));
}

TEST(Bsdf, ADiffuseLobeThatIsNotSampledStillCounts) {
  const BsdfSwitches off = {.diffuse_lobe = false};
  const vec3 view = view_at(0.6), light = view_at(0.8);
  const SurfacePoint both = surface(0.5f, 0.6f, 0.3f), diffuse = surface(0.5f, 0.6f, 0);
  EXPECT_EQ(bsdf_value(both, view, light, off), bsdf_value(both, view, light));
  EXPECT_NEAR(bsdf_value(diffuse, view, light, off).x, 0.6 * 0.8 / std::numbers::pi, 1e-6);
  EXPECT_EQ(bsdf_pdf(diffuse, view, light, off), 0);
  EXPECT_EQ(bsdf_sample(diffuse, view, 0.5f, {0.5f, 0.5f}, off).flags, BSDF_NONE);
  const BsdfSample next = bsdf_sample(both, view, 0, {0.5f, 0.5f}, off);
  EXPECT_EQ(next.flags, BSDF_GLOSSY);
  EXPECT_EQ(next.weight, bsdf_terms(both, view, next.light, off).glossy / next.pdf);
  EXPECT_EQ(next.pdf, bsdf_pdf(both, view, next.light, off));
}

float one_of(Random& random, const std::vector<float>& values) {
  return values[random.below(static_cast<uint>(values.size()))];
}

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A direction at, or as close as can be to, the normal, the plane and its other side.
vec3 extreme_direction(Random& random, const vec3& normal) {
  const float cosine =
      one_of(random, {1, 1, 0.5f, 0.1f, 1e-3f, 1e-5f, 1e-6f, 9.6e-7f, 1e-10f, 0, -1e-7f, -1});
  if (cosine == 1 && random.below(2) == 0) return normal;
  return Directions(normal).at(cosine, random.uniform(0, 6.3f));
}

TEST(Bsdf, AnyFiniteInputGivesFiniteBoundedResults) {
  Random random(17);
  const std::vector<float> parts = {0, 1e-38f, 1e-30f, 1e-12f, 0.03f, 0.0317f, 0.04f, 0.5f, 1, 2, -1, 3e38f};
  const std::vector<float> numbers = {0, 0x1p-24f, 0.5f - 0x1p-24f, 0.5f, 0.999f, 1 - 0x1p-24f};
  const std::vector<float> ratios = {0,    1e-30f, 0.0625f, 0.6f, 1 - 0x1p-24f, 1, 1 + 0x1p-23f,
                                     1.5f, 16,     3e38f,   -1};
  int reflected = 0;
  for (int i = 0; i < 300000; ++i) {
    SurfacePoint s;
    s.normal = i % 5 == 0 ? vec3(0, 0, i % 2 == 0 ? 1 : -1) : unit_vector(random.direction());
    s.roughness = one_of(random, parts);
    s.diffuse = vec3(one_of(random, parts), one_of(random, parts), one_of(random, parts));
    s.specular = vec3(one_of(random, parts), one_of(random, parts), one_of(random, parts));
    s.transmission = one_of(random, parts);
    s.ior_ratio = one_of(random, ratios);
    const vec3 view = extreme_direction(random, s.normal), light = extreme_direction(random, s.normal);
    const float lobe = one_of(random, numbers), u = one_of(random, numbers), v = one_of(random, numbers);
    const BsdfSwitches switches = {random.below(4) > 0, random.below(4) > 0, random.below(4) > 0};
    const BsdfSample next = bsdf_sample(s, view, lobe, {u, v}, switches);
    const BsdfTerms terms = bsdf_terms(s, view, light, switches);
    ASSERT_TRUE(finite(next.light) && finite(next.weight) && std::isfinite(next.pdf)) << i;
    ASSERT_TRUE(finite(terms.diffuse) && finite(terms.glossy) && std::isfinite(terms.pdf)) << i;
    for (int channel = 0; channel < 3; ++channel) {
      ASSERT_TRUE(next.weight[channel] >= 0 && next.weight[channel] <= 16)
          << i << " " << next.weight[channel];
      ASSERT_TRUE(terms.diffuse[channel] >= 0 && terms.glossy[channel] >= 0) << i;
    }
    ASSERT_NEAR(dot_product(next.light, next.light), next.flags == BSDF_NONE ? 0 : 1, 2e-6) << i;
    reflected += next.flags != BSDF_NONE;
  }
  EXPECT_GT(reflected, 50000);
}

}  // namespace
}  // namespace coppice
