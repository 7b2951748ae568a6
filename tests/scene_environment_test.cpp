// Environments of scene files: what is read and refused, which images are taken, what calls for the effect
// and what a frame then records.
#include <gtest/gtest.h>

#include <array>

#include "scene/write_exr.h"
#include "support/effect_scenes.h"
#include "support/environment_images.h"
#include "support/obj_folder.h"

namespace coppice {
namespace {

using nlohmann::json;

json with_environment(const json& environment) {
  json file = with_object();
  file["environment"] = environment;
  return file;
}

std::string error_with(const json& environment) { return scene_error_of(with_environment(environment)); }

TEST(SceneFileEnvironment, IsReadAndTurnedWithTheFile) {
  EXPECT_FALSE(read_scene(with_object()).environment);
  const Scene image =
      read_scene(with_environment({{"image", "dusk.hdr"}, {"rotation", -30}, {"intensity", 2.5}}));
  ASSERT_TRUE(image.environment);
  EXPECT_EQ(image.environment->image, "dusk.hdr");
  EXPECT_EQ(image.environment->rotation_degrees, -30);
  EXPECT_EQ(image.environment->intensity, 2.5f);
  EXPECT_FALSE(image.environment->sky);
  json file = with_environment({{"sky", {{"sun_direction", {0, 3, 4}}, {"turbidity", 5}, {"ground", 0.5}}}});
  const Environment sky = *read_scene(file).environment;
  EXPECT_EQ(sky.sky->sun, glm::vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(sky.sky->turbidity, 5);
  EXPECT_EQ(sky.sky->ground, 0.5f);
  EXPECT_EQ(sky.intensity, 1);
  file["up"] = "z";
  const glm::vec3 sun = read_scene(file).environment->sky->sun;
  EXPECT_NEAR(sun.y, 0.8, 1e-6);
  EXPECT_NEAR(sun.z, -0.6, 1e-6);
  EXPECT_EQ(read_scene(with_environment({{"sky", json::object()}})).environment->sky->turbidity, 3);
}

TEST(SceneFileEnvironment, ErrorsNameTheirPlace) {
  const json sky = json::object();
  EXPECT_EQ(error_with(json::object()),
            "s.json: /environment: expected an \"image\" or a \"sky\", one of both");
  EXPECT_EQ(error_with({{"image", "a.hdr"}, {"sky", sky}}),
            "s.json: /environment: expected an \"image\" or a \"sky\", one of both");
  EXPECT_EQ(error_with({{"sky", sky}, {"rotation", 5}}),
            "s.json: /environment/rotation: goes with an \"image\", expected a \"sun_direction\" of the sky");
  EXPECT_EQ(
      error_with({{"sky", {{"sun_direction", {1, -1, 0}}}}}),
      "s.json: /environment/sky/sun_direction: [1,-1,0], expected a direction that is not below the horizon");
  EXPECT_EQ(error_with({{"sky", {{"sun_direction", {0, 0, 0}}}}}).substr(0, 50),
            "s.json: /environment/sky/sun_direction: [0,0,0], e");
  EXPECT_EQ(error_with({{"sky", {{"turbidity", 1}}}}),
            "s.json: /environment/sky/turbidity: 1, expected a number from 2 to 10");
  EXPECT_EQ(error_with({{"sky", {{"ground", 2}}}}),
            "s.json: /environment/sky/ground: 2, expected a number from 0 to 1");
  EXPECT_EQ(error_with({{"sky", sky}, {"intensity", -1}}).substr(0, 38),
            "s.json: /environment/intensity: -1, ex");
  EXPECT_EQ(error_with({{"image", ""}}).substr(0, 32), "s.json: /environment/image: \"\", ");
  EXPECT_EQ(error_with({{"image", "a.hdr"}, {"rotation", 1e9}}).substr(0, 38),
            "s.json: /environment/rotation: 1000000");
  EXPECT_EQ(error_with({{"image", "a.hdr"}, {"blur", 1}}).substr(0, 40),
            "s.json: /environment/blur: unknown key, ");
}

// --- Images.

using RadianceImages = ObjFolder;
using EnvironmentEffect = ObjFolder;

std::string decoding_error_of(std::string_view bytes) {
  try {
    decode_radiance(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RadianceImages, IsReadFromRadianceHdr) {
  const RadianceImage image = decode_radiance(hdr_of(2, 1, {{{128, 64, 32, 129}}, {{128, 0, 255, 137}}}));
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(image.height, 1u);
  EXPECT_EQ(image.pixels[0], glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(image.pixels[1], glm::vec3(256, 0, 510));
}

TEST_F(RadianceImages, IsReadFromOpenExrWithoutWhatIsNoRadiance) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec3> pixels = {{1, 2, 3}, {-1, nan, infinity}, {0.1f, 0, 1e30f}};
  write_exr(folder_ / "three.exr", 3, 1, pixels);
  const Environment environment{.image = "THREE.EXR", .folder = folder_.string(), .sky = {}, .origin = ""};
  std::string warning;
  const RadianceImage image = load_radiance(environment, warning);
  EXPECT_EQ(warning, "");
  ASSERT_EQ(image.pixels.size(), 3u);
  EXPECT_EQ(image.pixels[0], pixels[0]);
  EXPECT_EQ(image.pixels[1], glm::vec3(0, 0, MAX_RADIANCE));
  EXPECT_EQ(image.pixels[2], glm::vec3(0.1f, 0, MAX_RADIANCE));
}

TEST_F(RadianceImages, WhatCannotBeReadIsSaidInOneLine) {
  EXPECT_EQ(decoding_error_of(""), "neither Radiance HDR nor OpenEXR");
  EXPECT_EQ(decoding_error_of("\x89PNG"), "neither Radiance HDR nor OpenEXR");
  EXPECT_EQ(decoding_error_of("#?RADIANCE\n").substr(0, 36), "no Radiance HDR that can be read (un");
  const std::string exr = decoding_error_of(std::string_view("\x76\x2f\x31\x01\x02\0\0\0", 8));
  EXPECT_EQ(exr.substr(0, 35), "no OpenEXR image that can be read (");
  EXPECT_EQ(exr.find('\n'), std::string::npos);
}

TEST_F(RadianceImages, OneThatIsMissingOrBrokenIsNamedAndACheckerTakesItsPlace) {
  write("broken.hdr", "#?RADIANCE\n");
  const auto warning_of = [&](const char* name) {
    const Environment environment{
        .image = name, .folder = folder_.string(), .sky = {}, .origin = "/environment"};
    std::string warning;
    const RadianceImage image = load_radiance(environment, warning);
    EXPECT_EQ(image.pixels[0], glm::vec3(1, 0, 1));
    EXPECT_EQ(image.pixels[4], glm::vec3(0));
    return warning;
  };
  EXPECT_EQ(warning_of("none.hdr"),
            (folder_ / "none.hdr").string() + ": no such file, a checker takes its place as /environment");
  EXPECT_NE(warning_of("broken.hdr").find("no Radiance HDR that can be read"), std::string::npos);
  Scene scene = with_light();
  scene.environment = Environment{.image = "none", .folder = "nowhere", .sky = {}, .origin = "/environment"};
  EXPECT_EQ(
      scene_arrays(scene).image_warnings(),
      std::vector<std::string>{"nowhere/none: no such file, a checker takes its place as /environment"});
  EXPECT_TRUE(scene_arrays(scene, effects_of(scene, EffectChanges("-environment"))).image_warnings().empty());
}

// --- The effect.

Scene under_sky() {
  Scene scene = with_light();
  scene.light_origin.clear();
  scene.environment = Environment{.image = "", .folder = "", .sky = Sky{}, .origin = "/environment"};
  return scene;
}

TEST_F(EnvironmentEffect, IsCalledForByTheKeyAndCallsForShadows) {
  Scene scene = under_sky();
  EXPECT_EQ(caller(scene, Effect::environment), "/environment");
  EXPECT_EQ(caller(scene, Effect::shadows), "/environment");
  EXPECT_TRUE(effects_of(scene).follows_paths());
  EXPECT_FALSE(effects_of(scene, EffectChanges("-environment")).has(Effect::shadows));
  EXPECT_FALSE(effects_of(scene, EffectChanges("-environment")).follows_paths());
  EXPECT_FALSE(effects_of(with_light(), EffectChanges("+environment")).follows_paths()) << "there is none";
  scene.environment->intensity = 0;
  EXPECT_EQ(caller(scene, Effect::environment), "");
}

TEST_F(EnvironmentEffect, LeavesOutTheDefaultLightAndAmbientLight) {
  Scene scene = under_sky();
  EXPECT_TRUE(path_lights(scene, effects_of(scene)).empty());
  EXPECT_EQ(scene_arrays(scene).paths.surroundings[0].radiance, vec3(0));
  scene.light_origin = "/light";
  EXPECT_EQ(path_lights(scene, effects_of(scene)).size(), 1u);
  scene.environment.reset();
  scene.global_illumination = true;
  EXPECT_EQ(scene_arrays(scene).paths.surroundings[0].radiance, scene.ambient_light);
  EXPECT_EQ(scene_arrays(scene).paths.surroundings.size(), 1u);
}

TEST_F(EnvironmentEffect, IsChosenAsOftenAsEachOtherKindOfLight) {
  Scene scene = under_sky();
  const auto environment_of = [](const Scene& of) {
    const PathArrays paths = scene_arrays(of).paths;
    EXPECT_EQ(paths.choices.back().source, LIGHT_CHOICE_ENVIRONMENT);
    EXPECT_EQ(paths.choices.back().end, LIGHT_CHOICE_RANGE);
    EXPECT_EQ(paths.choices.back().shadows, 1u);
    return paths.choices.back().probability;
  };
  EXPECT_EQ(environment_of(scene), 1);
  scene.more_lights.push_back({.is_point = true, .origin = "lamp"});
  EXPECT_EQ(environment_of(scene), 0.5f);
  scene.materials[scene.material_index[0]].emission = vec3(1);
  EXPECT_NEAR(environment_of(scene), 1 / 3.0, 1e-6);
  write_exr(folder_ / "black.exr", 2, 1, std::vector<glm::vec3>(2, glm::vec3(0)));
  scene.environment = Environment{.image = "black.exr", .folder = folder_.string(), .sky = {}, .origin = ""};
  for (const LightChoice& choice : scene_arrays(scene).paths.choices)
    EXPECT_NE(choice.source, LIGHT_CHOICE_ENVIRONMENT) << "no light comes from it";
}

TEST_F(EnvironmentEffect, RecordsThePathsThatEndAtOnceAndNothingWhereItIsOff) {
  const Scene scene = under_sky();
  const RecordedPicture on = recorded(scene), off = recorded(scene, "-environment"),
                        plain = recorded(with_light());
  EXPECT_EQ(kernels_of(on),
            "camera_rays*1 trace_closest*1 path_start*1 path_surfaces*1 path_lights*1 scan_tile_sums*1 "
            "prefix_scan*2 path_queue*1 trace_any*1 path_light_add*1 resolve*1");
  EXPECT_EQ(on.effect_steps[static_cast<std::size_t>(Effect::environment)], 1u);
  EXPECT_GT(on.device_bytes, std::uint64_t{512} * 513 * 16);
  EXPECT_EQ(kernels_of(off), kernels_of(plain));
  EXPECT_EQ(off.device_bytes, plain.device_bytes);
  EXPECT_EQ(off.slots, plain.slots);
  EXPECT_EQ(off.effect_steps[static_cast<std::size_t>(Effect::environment)], 0u);
  // Of paths without one, not even their room.
  Scene bounced = with_light();
  bounced.global_illumination = true;
  EXPECT_LT(recorded(bounced).device_bytes + std::uint64_t{512} * 512 * 16, on.device_bytes + 500000);
  EXPECT_EQ(recorded(bounced).effect_steps[static_cast<std::size_t>(Effect::environment)], 0u);
}

TEST_F(EnvironmentEffect, ASceneWithNoOtherLightIsNotDark) {
  json file = with_environment({{"sky", json::object()}});
  file["light"] = {{"radiance", {0, 0, 0}}, {"ambient", {0, 0, 0}}};
  EXPECT_TRUE(read_scene(file).warnings.empty());
  file["environment"]["intensity"] = 0;
  EXPECT_FALSE(read_scene(file).warnings.empty());
}

}  // namespace
}  // namespace coppice
