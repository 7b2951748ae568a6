// Paths of light: every stage in lockstep with its twin, radiance against closed forms, the same bits through
// every tree and however a trace is cut.
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "render/film.h"
#include "support/path_frame.h"
#include "support/path_scene.h"
#include "support/test_device.h"
#include "support/textured_scene.h"

namespace coppice {
namespace {

using DevicePaths = DeviceTest;

TEST_F(DevicePaths, EveryStageDoesWhatItsTwinDoes) {
  for (const Walk walk : {Walk::binary, Walk::wide_single, Walk::wide_packets}) {
    EXPECT_EQ(difference_of(room_of_all_surfaces(), PathView{.samples = 2, .walk = walk}), "");
  }
}

TEST_F(DevicePaths, EveryStageDoesWhatItsTwinDoesWithTextures) {
  Scene scene = textured_scene(100);
  scene.global_illumination = true;
  scene.bounces = 2;
  EXPECT_EQ(difference_of(scene, PathView{}), "");
}

TEST_F(DevicePaths, TheSameBitsThroughEveryTreeAndHoweverATraceIsCut) {
  const Scene scene = room_of_all_surfaces();
  const PathView view{.width = 96, .height = 72, .samples = 2};
  const PathPicture whole = path_picture(scene, view);
  EXPECT_GT(whole.lobes.diffuse.x, 1000u);
  EXPECT_GT(whole.lobes.reflected.x, 100u);
  EXPECT_GT(whole.lobes.transmitted.x, 100u);
  EXPECT_EQ(whole.bounced.rays,
            std::uint64_t{whole.lobes.diffuse.x} + whole.lobes.reflected.x + whole.lobes.transmitted.x);
  for (const Walk walk : {Walk::binary, Walk::wide_single, Walk::wide_packets}) {
    PathView other = view;
    other.walk = walk;
    other.work = 1;
    const PathPicture cut = path_picture(scene, other);
    EXPECT_EQ(cut.radiance, whole.radiance);
    EXPECT_EQ(cut.bounced.rays, whole.bounced.rays);
    EXPECT_EQ(cut.light.rays, whole.light.rays);
    EXPECT_EQ(cut.light.hits, whole.light.hits);
  }
}

// Inside of a closed room of one albedo, all of which emits, the radiance is emission / (1 - albedo).
TEST_F(DevicePaths, AFurnaceIsAsBrightAsItMustBeByEachStrategyAndBoth) {
  const Scene scene = furnace(0.5f, 0.25f);
  for (const char* const changes : {"", "-emission"}) {  // light samples and bounces, bounces alone
    const PathPicture lit =
        path_picture(scene, {.width = 64, .height = 48, .samples = 8, .changes = changes});
    const glm::dvec3 mean = mean_radiance_of(lit.radiance);
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean[channel], 0.5, 0.005) << changes;
  }
}

// Irradiance under the middle of a parallel square by its radiance: 4 times that of a corner of a quarter
// (for instance J. Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3).
double irradiance_under_square(double half_side, double height) {
  const double x = half_side / height, root = std::sqrt(1 + x * x);
  return 4 * (x / root * std::atan(x / root));
}

TEST_F(DevicePaths, ASquareLightIsAsBrightAsTheClosedFormAndHalfCoveredHalfAsBright) {
  for (const bool covered : {false, true}) {
    const Scene scene = square_light_over_plane(covered);
    const PathPicture lit = path_picture(scene, {.width = 4, .height = 4, .samples = 1024});
    const double open = 0.8 / std::numbers::pi * irradiance_under_square(1, 2) * 3;
    EXPECT_NEAR(mean_radiance_of(lit.radiance).x, covered ? open / 2 : open, 0.01 * open) << covered;
    EXPECT_EQ(lit.light.hits > 0, covered);
    EXPECT_EQ(lit.bounced.rays, 0u);
  }
}

// Where no path goes on to meet a lamp, what is sampled of it is not shared with what would have been met.
TEST_F(DevicePaths, LightSamplesOfTheLastBounceCountInFull) {
  Scene scene = square_light_over_plane(false);
  scene.global_illumination = true;
  for (const std::uint32_t bounces : {0u, 1u}) {
    scene.bounces = bounces;
    const PathPicture lit = path_picture(scene, {.width = 4, .height = 4, .samples = 1024});
    const double open = 0.8 / std::numbers::pi * irradiance_under_square(1, 2) * 3;
    EXPECT_NEAR(mean_radiance_of(lit.radiance).x, open, 0.01 * open) << bounces;
  }
}

// What an angle of incidence makes of unpolarised light (Fresnel 1823).
double fresnel(double cosine, double ior) {
  const double inner = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double s = (cosine - ior * inner) / (cosine + ior * inner);
  const double p = (ior * cosine - inner) / (ior * cosine + inner);
  return (s * s + p * p) / 2;
}

// With all reflections inside of the slab (1 - F) / (1 + F) of what is behind it comes through.
TEST_F(DevicePaths, ASlabOfGlassLetsThroughWhatFresnelSays) {
  for (const double tangent : {0.0, 1.0, 2.5}) {
    Scene scene = glass_slab(static_cast<float>(tangent));
    scene.bounces = 32;
    const PathPicture seen = path_picture(scene, {.width = 64, .height = 64, .samples = 4});
    const double reflectance = fresnel(1 / std::sqrt(1 + tangent * tangent), 1.5);
    EXPECT_NEAR(mean_radiance_of(seen.radiance).y, (1 - reflectance) / (1 + reflectance), 0.015) << tangent;
  }
}

// Snell: the edge that is seen through the slab is displaced by its depth times the difference of tangents.
TEST_F(DevicePaths, ASlabOfGlassDisplacesWhatIsBehindItAsSnellSays) {
  constexpr double tangent = 1, depth = 1;
  const double sine = tangent / std::sqrt(1 + tangent * tangent) / 1.5;
  const double shift = depth * (tangent - sine / std::sqrt(1 - sine * sine));
  for (const double off : {-0.02, 0.02}) {
    const Scene scene = glass_slab_before_edge(static_cast<float>(tangent), static_cast<float>(shift + off));
    const PathPicture seen = path_picture(scene, {.width = 2, .height = 2, .samples = 64});
    // Bright on one side of the displaced edge, on the other only what is reflected twice within the slab.
    EXPECT_EQ(mean_radiance_of(seen.radiance).y > 0.4, off > 0) << off;
  }
}

TEST_F(DevicePaths, AMirrorShowsWhatIsBeforeItTimesItsColour) {
  const PathPicture seen = path_picture(mirror_scene(0.75f), {.width = 4, .height = 4, .samples = 16});
  const double rise = std::pow(1 - std::sqrt(0.5), 5);  // Schlick's, at 45 degrees
  for (const vec3& radiance : seen.radiance) EXPECT_NEAR(radiance.x, 2 * (0.75 + 0.25 * rise), 1e-3);
  EXPECT_EQ(seen.lobes.reflected.x, 4u * 4 * 16);
  const PathPicture without =
      path_picture(mirror_scene(0.75f), {.width = 4, .height = 4, .changes = "-reflection"});
  EXPECT_EQ(without.bounced.rays, 0u);
}

TEST_F(DevicePaths, AGlossySurfaceIsAsBrightWithLightSamplesAsWithout) {
  const Scene scene = glossy_scene(0.4f);
  const double both =
      mean_radiance_of(path_picture(scene, {.width = 8, .height = 8, .samples = 1024}).radiance).x;
  PathView bounces{.width = 8, .height = 8, .samples = 4096};
  bounces.changes = "-emission";
  const double alone = mean_radiance_of(path_picture(scene, bounces).radiance).x;
  EXPECT_GT(alone, 0.05);
  EXPECT_NEAR(both, alone, 0.02 * alone);
}

}  // namespace
}  // namespace coppice
