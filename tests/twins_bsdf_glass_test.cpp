// What goes through surfaces: Snell's and Fresnel's laws, total internal reflection, rough glass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/surface_points.h"

namespace coppice {
namespace {

using namespace twins;

// Closed forms, in double: reflectance of light from index 1 to n, polarized both ways.
double fresnel(double cosine, double n) {
  const double sine = std::sqrt(1 - cosine * cosine) / n;
  if (sine >= 1) return 1;
  const double refracted = std::sqrt(1 - sine * sine);
  const double s = (cosine - n * refracted) / (cosine + n * refracted);
  const double p = (n * cosine - refracted) / (n * cosine + refracted);
  return (s * s + p * p) / 2;
}

TEST(BsdfGlass, GlassFollowsSnellAndFresnelAndLosesNothing) {
  const Directions directions(some_normal());
  for (const double n : {1.5, 1 / 1.5, 1.1, 2.4, 1 / 1.33})
    for (int step = 1; step <= 200; ++step) {
      const double cosine = step / 200.0, sine = std::sqrt(1 - cosine * cosine);
      const SurfacePoint s = surface(0, 0, 0.04f, 1, static_cast<float>(1 / n));
      const vec3 view = view_at(cosine);
      double reflected = 0, transmitted = 0;
      constexpr int count = 2000;
      for (int i = 0; i < count; ++i) {
        const BsdfSample next = bsdf_sample(s, view, (static_cast<float>(i) + 0.5f) / count, {0.3f, 0.6f});
        ASSERT_NE(next.flags, BSDF_NONE);
        (next.flags == BSDF_MIRROR ? reflected : transmitted) += static_cast<double>(next.weight.x) / count;
        if (next.flags != BSDF_TRANSMISSION) continue;
        const double side = directions.of(next.light).x;
        EXPECT_LT(side, 0);
        EXPECT_NEAR(std::sqrt(std::max(1 - side * side, 0.0)), sine / n, 2e-3);
        EXPECT_NEAR(side, -std::sqrt(1 - sine * sine / (n * n)), 1e-3);
        // In the plane of view and normal.
        const glm::dvec3 across = Directions::crossed(glm::dvec3(view), directions.normal);
        EXPECT_NEAR(Directions::dotted(across, glm::dvec3(next.light)), 0, 1e-6);
      }
      EXPECT_NEAR(reflected + transmitted, 1, 1e-3);
      EXPECT_NEAR(reflected, fresnel(cosine, n), 1e-3) << n << " at " << cosine;
      if (sine >= n) {
        EXPECT_EQ(transmitted, 0);
      }
    }
}

TEST(BsdfGlass, GlassWithoutReflectingLobeTransmitsAllAndReflectsWhereReflectionIsTotal) {
  const SurfacePoint inside = surface(0, 0, 0, 1, 1.5f);
  const BsdfSample through = bsdf_sample(inside, view_at(0.9), 0.5f, {0, 0});
  EXPECT_EQ(through.flags, BSDF_TRANSMISSION);
  EXPECT_EQ(through.weight, vec3(1));
  const BsdfSample back = bsdf_sample(inside, view_at(0.5), 0.5f, {0, 0});
  EXPECT_EQ(back.flags, BSDF_MIRROR);
  EXPECT_EQ(back.weight, vec3(1));
  EXPECT_NEAR(dot_product(back.light, some_normal()), 0.5, 1e-6);
}

TEST(BsdfGlass, WithoutChangeOfMediumLightGoesStraightOn) {
  for (const float roughness : {0.0f, 0.7f}) {
    const SurfacePoint s = surface(roughness, 0.5f, 0, 0.75f);
    for (const double cosine : {1.0, 0.3, 0.001}) {
      const vec3 view = view_at(cosine);
      const BsdfSample next = bsdf_sample(s, view, 0.99f, {0.4f, 0.2f});
      EXPECT_EQ(next.flags, BSDF_TRANSMISSION);
      EXPECT_EQ(next.light, -view);
      EXPECT_NEAR(means_of(s, view, 4096).without_density.x, 0.75, 1e-3);
    }
  }
}

// As rough glass becomes smoother its light comes together where smooth glass refracts it.
TEST(BsdfGlass, RoughGlassScattersAboutTheRefractedDirection) {
  const vec3 view = view_at(0.8);
  const vec3 smooth = bsdf_sample(surface(0, 0, 0.04f, 1, 1 / 1.5f), view, 0.99f, {0, 0}).light;
  double before = 2;
  for (const float roughness : {0.5f, 0.25f, 0.1f, 0.04f}) {
    double distance = 0;
    for (uint i = 0; i < 256; ++i) {
      const BsdfSample next =
          bsdf_sample(surface(roughness, 0, 0.04f, 1, 1 / 1.5f), view, 0.99f, sample_2d(2, i, 0));
      distance += 1 - static_cast<double>(dot_product(next.light, smooth));
    }
    EXPECT_LT(distance / 256, before / 3);
    before = distance / 256;
  }
  EXPECT_LT(before, 1e-5);
}

// Between media of nearly one index light goes nearly straight on, so what is left of it is Smith's masking
// of the way out.
TEST(BsdfGlass, FacetsHideOthersOnTheWayOut) {
  for (const double cosine : {1.0, 0.6, 0.2})
    for (const double alpha : {0.25, 0.81}) {
      const SurfacePoint s = surface(static_cast<float>(std::sqrt(alpha)), 0, 0, 1, 0.9999f);
      const double slope = std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine);
      const double through = means_of(s, view_at(cosine), 4096).without_density.x;
      EXPECT_NEAR(through, 2 * cosine / (cosine + slope), 2e-3) << cosine << " " << alpha;
    }
}

}  // namespace
}  // namespace coppice
