// Fog of scene files: what is read and refused, what calls for the effect and what a frame then records; and
// the functions that its stage is made of.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "support/effect_scenes.h"
#include "twins/exponential.h"
#include "twins/fog.h"

namespace coppice {
namespace {

using nlohmann::json;

json with_fog(const json& fog) {
  json file = with_object();
  file["fog"] = fog;
  return file;
}

std::string error_of_fog(const json& fog) { return scene_error_of(with_fog(fog)); }

TEST(SceneFileFog, IsReadAndStandsWithTheScene) {
  EXPECT_FALSE(read_scene(with_object()).fog);
  const Scene whole = read_scene(with_fog({{"density", 0.25}}));
  ASSERT_TRUE(whole.fog);
  EXPECT_EQ(whole.fog->density, 0.25f);
  EXPECT_EQ(whole.fog->albedo, glm::vec3(1));
  EXPECT_EQ(whole.fog->anisotropy, 0);
  EXPECT_FALSE(whole.fog->box);
  json file = with_fog({{"density", 2},
                        {"albedo", {0.5, 1, 0.25}},
                        {"anisotropy", -0.5},
                        {"box", {{"min", {1, 2, 3}}, {"max", {4, 6, 8}}}}});
  EXPECT_EQ(read_scene(file).fog->box->min, glm::vec3(1, 2, 3));
  EXPECT_EQ(read_scene(file).fog->box->max, glm::vec3(4, 6, 8));
  file["up"] = "z";
  Scene turned = read_scene(file);
  EXPECT_EQ(turned.fog->box->min, glm::vec3(1, 3, -6));
  EXPECT_EQ(turned.fog->box->max, glm::vec3(4, 8, -2));
  EXPECT_EQ(turned.fog->albedo, glm::vec3(0.5f, 1, 0.25f));
  stand_up(turned, "x");  // as --up does
  EXPECT_EQ(turned.fog->box->min, glm::vec3(-8, 1, -6));
  EXPECT_EQ(turned.fog->box->max, glm::vec3(-3, 4, -2));
}

// The same part of the light comes through, whatever the unit of length.
TEST(SceneFileFog, ComesIntoRangeWithTheScene) {
  Scene scene = read_scene(with_fog({{"density", 0.5}, {"box", {{"min", {0, 0, 0}}, {"max", {1, 1, 2}}}}}));
  for (glm::vec3& position : scene.positions) position *= 0x1p-40f;
  bring_into_range(scene);
  const int exponent = scene.scale_exponent;
  ASSERT_GT(exponent, 0);
  EXPECT_EQ(scene.fog->density, std::ldexp(0.5f, -exponent));
  EXPECT_EQ(scene.fog->box->max, glm::vec3(1, 1, 2) * std::ldexp(1.0f, exponent));
}

TEST(SceneFileFog, ErrorsNameTheirPlace) {
  EXPECT_EQ(error_of_fog({{"density", 0}}).substr(0, 20), "s.json: /fog/density");
  EXPECT_EQ(error_of_fog(json::object()).substr(0, 12), "s.json: /fog");
  EXPECT_EQ(error_of_fog({{"density", 1}, {"albedo", {1, 1, 2}}}).substr(0, 21), "s.json: /fog/albedo/2");
  EXPECT_EQ(error_of_fog({{"density", 1}, {"anisotropy", 1}}).substr(0, 23), "s.json: /fog/anisotropy");
  EXPECT_EQ(error_of_fog({{"density", 1}, {"box", {{"min", {0, 0, 0}}, {"max", {1, 0, 1}}}}}),
            "s.json: /fog/box/max/1: 0, expected a number above that of \"min\"");
}

TEST(FogEffect, IsCalledForByTheFileAndRecordsItsStage) {
  Scene scene = read_scene(with_fog({{"density", 1}}));
  EXPECT_EQ(caller(scene, Effect::fog), "/fog");
  EXPECT_FALSE(effects_of(read_scene(with_object()), EffectChanges("+fog")).follows_paths());
  scene.light.shadows = true;
  const RecordedPicture fog = recorded(scene), clear = recorded(scene, "-fog");
  EXPECT_EQ(
      kernels_of(fog),
      "camera_rays*1 trace_closest*1 path_start*1 path_fog*1 scan_tile_sums*2 prefix_scan*4 path_queue*2 "
      "trace_any*2 path_light_add*2 path_surfaces*1 path_lights*1 resolve*1");
  EXPECT_EQ(
      kernels_of(clear),
      "camera_rays*1 trace_closest*1 shade*1 shadow_marks*1 scan_tile_sums*1 prefix_scan*2 shadow_rays*1 "
      "trace_any*1 shade_lights*1 resolve*1");
  scene.global_illumination = true;
  EXPECT_EQ(recorded(scene).device_bytes, recorded(scene, "-fog").device_bytes)
      << "its numbers fit into the room between two slots";
  EXPECT_EQ(scene_arrays(scene, effects_of(scene)).paths.surroundings.size(), 4u);
  EXPECT_EQ(scene_arrays(scene, effects_of(scene, EffectChanges("-fog"))).paths.surroundings.size(), 1u);
}

// --- The functions.

double units_apart(float value, double exact) {
  const float rounded = static_cast<float>(exact);
  return std::abs(value - exact) / (std::nextafter(std::abs(rounded), INFINITY) - std::abs(rounded));
}

TEST(Exponential, IsWithinUnitsOfTheLastPlace) {
  double worst_exp = 0, worst_rest = 0;
  for (float x = 0x1p-30f; x < 86.9f; x *= 1.0007f) {
    worst_exp = std::max(worst_exp, units_apart(twins::exp_minus(x), std::exp(-double{x})));
    worst_rest = std::max(worst_rest, units_apart(twins::one_minus_exp(x), -std::expm1(-double{x})));
  }
  EXPECT_LE(worst_exp, 2);
  EXPECT_LE(worst_rest, 16);
  EXPECT_EQ(twins::exp_minus(0), 1);
  EXPECT_EQ(twins::one_minus_exp(0), 0);
  for (const float x : {87.0f, 1e30f, INFINITY, NAN}) EXPECT_EQ(twins::exp_minus(x), 0) << x;
}

TEST(Exponential, LogarithmIsItsInverse) {
  double worst = 0;
  for (float y = 0x1p-100f; y < 1; y *= 1.0009f)
    worst = std::max(worst, units_apart(twins::minus_log(y), -std::log(double{y})));
  EXPECT_LE(worst, 4);
  EXPECT_EQ(twins::minus_log(1), 0);
  EXPECT_NEAR(twins::minus_log(std::nextafter(1.0f, 0.0f)) / 0x1p-24, 1, 1e-6);
}

TEST(FogFunctions, PhaseIsADensityOverTheSphereWhoseMeanCosineIsItsNumber) {
  for (const float anisotropy : {-0.95f, -0.3f, 0.0f, 0.5f, 0.95f}) {
    double sum = 0, cosines = 0;
    constexpr int steps = 200'000;
    for (int i = 0; i < steps; ++i) {
      const double cosine = -1 + (i + 0.5) * 2 / steps;
      const double part =
          twins::phase_of(anisotropy, static_cast<float>(cosine)) * 2 * std::numbers::pi * 2 / steps;
      sum += part;
      cosines += part * cosine;
    }
    EXPECT_NEAR(sum, 1, 1e-4) << anisotropy;
    EXPECT_NEAR(cosines, anisotropy, 1e-4);
  }
}

TEST(FogFunctions, ReachIsTheWayInTheBox) {
  const twins::Fog fog{{-1, -1, -1}, {1, 1, 1}, vec3(1), 0.5f, 0};
  const auto depth = [&](vec3 origin, vec3 direction, float t_max) {
    return twins::optical_depth(fog, direction, twins::reach_of_fog(fog, {origin, 0, direction, t_max}));
  };
  EXPECT_EQ(depth({0, 0, 5}, {0, 0, -1}, INFINITY), 1);
  EXPECT_EQ(depth({0, 0, 5}, {0, 0, -2}, INFINITY), 1) << "of any length";
  EXPECT_EQ(depth({0, 0, 5}, {0, 0, -1}, 5), 0.5f);
  EXPECT_EQ(depth({0, 0, 5}, {0, 0, -1}, 3), 0);
  EXPECT_EQ(depth({0, 0, 5}, {0, 0, 1}, INFINITY), 0);
  EXPECT_EQ(depth({0, 0, 0}, {0, 0, 1}, INFINITY), 0.5f);
  EXPECT_EQ(depth({0, 2, 5}, {0, 0, -1}, INFINITY), 0);
  EXPECT_EQ(depth({0, 1, 5}, {0, 0, -1}, INFINITY), 1) << "a side is inside";
  EXPECT_EQ(depth({0, 0, 0}, {0, 0, 0}, 1), 0);
}

}  // namespace
}  // namespace coppice
