// Which scenes call for paths of light, what paths then take of them, and what a frame records.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scene/surface_effects.h"
#include "support/effect_scenes.h"

namespace coppice {
namespace {

Material named(const char* name) {
  Material material;
  material.name = name;
  return material;
}

// A scene with a triangle of that material.
Scene made_of(const Material& material) {
  Scene scene = with_light();
  scene.materials.push_back(material);
  scene.material_index.back() = static_cast<std::uint32_t>(scene.materials.size() - 1);
  return scene;
}

TEST(PathEffects, WhatEmitsReflectsOrLetsLightThroughCallsForPaths) {
  Material lamp = named("lamp");
  lamp.emission = {0, 1, 0};
  EXPECT_EQ(caller(made_of(lamp), Effect::emission), "material 'lamp', which emits light");
  EXPECT_EQ(caller(made_of(lamp), Effect::shadows), "material 'lamp', which emits light");
  const auto has_shadows = [&](const char* changes) {
    return effects_of(made_of(lamp), EffectChanges(changes)).has(Effect::shadows);
  };
  EXPECT_TRUE(has_shadows(""));
  EXPECT_FALSE(has_shadows("-emission"));
  EXPECT_FALSE(has_shadows("-shadows"));
  EXPECT_TRUE(has_shadows("-emission,+shadows"));
  lamp.is_unlit = true;
  EXPECT_EQ(caller(made_of(lamp), Effect::emission), "");
  for (const int illum : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    Material surface = named("surface");
    surface.illum = illum;
    surface.opacity = 0.5f;
    EXPECT_EQ(caller(made_of(surface), Effect::reflection), "") << illum;  // Ks is black
    surface.specular = {0, 0, 0.5f};
    const bool reflects = illum >= 3 && illum <= 7, refracts = illum == 4 || illum == 6 || illum == 7;
    EXPECT_EQ(!caller(made_of(surface), Effect::reflection).empty(), reflects) << illum;
    EXPECT_EQ(!caller(made_of(surface), Effect::refraction).empty(), refracts) << illum;
    surface.opacity = 1;
    EXPECT_EQ(transmission_of(surface), illum == 6 || illum == 7 ? 1 : 0) << illum;
  }
  Material metal = named("metal");
  metal.metallic = 0.1f;
  EXPECT_EQ(caller(made_of(metal), Effect::reflection), "material 'metal', which reflects");
  metal.metallic_map.name = "map";  // paths do not read it
  EXPECT_EQ(caller(made_of(metal), Effect::reflection), "");
  Scene scene = with_light();
  EXPECT_FALSE(effects_of(scene, EffectChanges("+reflection,+refraction,+emission")).follows_paths());
  EXPECT_TRUE(effects_of(scene, EffectChanges("+global_illumination")).follows_paths());
  scene.global_illumination = true;
  EXPECT_EQ(caller(scene, Effect::global_illumination), "/global_illumination");
}

TEST(PathEffects, EmittersTakeThePlaceOfTheDefaultLight) {
  Scene scene = make_built_in("grove");
  scene.materials[scene.material_index[0]].emission = glm::vec3(1);
  EXPECT_TRUE(path_lights(scene, effects_of(scene)).empty());
  EXPECT_EQ(path_lights(scene, effects_of(scene, EffectChanges("-emission"))).size(), 1u);
  scene.light_origin = "/light";
  EXPECT_EQ(path_lights(scene, effects_of(scene)).size(), 1u);
}

TEST(PathEffects, LightsAreChosenInProportionToTheirPower) {
  Scene scene;
  scene.light.radiance = vec3(0);
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  scene.indices = {{0, 1, 2}, {0, 3, 2}, {0, 0, 3}};  // the last one has no area
  scene.material_index = {0, 1, 1};
  scene.materials = {named("dim"), named("bright")};
  scene.materials[0].emission = vec3(1);
  scene.materials[1].emission = vec3(3);
  scene.more_lights.push_back({.is_point = true, .origin = "lamp"});
  const PathArrays paths = scene_arrays(scene, effects_of(scene)).paths;
  ASSERT_EQ(paths.choices.size(), 3u);
  uint before = 0;
  for (const LightChoice& choice : paths.choices) {
    EXPECT_EQ(choice.probability * LIGHT_CHOICE_RANGE, choice.end - before);
    before = choice.end;
  }
  EXPECT_EQ(before, LIGHT_CHOICE_RANGE);
  EXPECT_EQ(paths.choices[0].source, LIGHT_CHOICE_LISTED);
  EXPECT_EQ(paths.choices[0].probability, 0.5f);
  EXPECT_NEAR(paths.emitter_probability[0], 0.5 / 7, 1e-6);
  EXPECT_NEAR(paths.emitter_probability[1], 3.0 / 7, 1e-6);
  EXPECT_EQ(paths.emitter_probability[2], 0);
}

TEST(PathEffects, RecordTheirStagesByTheBounce) {
  Material mirror = named("mirror");
  mirror.illum = 3;
  mirror.specular = glm::vec3(1);
  Scene scene = made_of(mirror);
  scene.bounces = 2;
  const RecordedPicture on = recorded(scene), off = recorded(scene, "-reflection");
  EXPECT_EQ(kernels_of(on),
            "camera_rays*1 trace_closest*3 path_start*1 path_surfaces*3 path_lights*3 path_bounce*2 "
            "scan_tile_sums*2 prefix_scan*4 path_queue*2 resolve*1");
  EXPECT_EQ(kernels_of(off), "camera_rays*1 trace_closest*1 shade_pixels*1");
  EXPECT_GT(on.device_bytes, off.device_bytes);
  for (const char* slot : {"paths", "path_rays", "surfaces", "light_choices", "bounce_counters"}) {
    EXPECT_TRUE(has_slot(on, slot)) << slot;
    EXPECT_FALSE(has_slot(off, slot)) << slot;
  }
  for (std::size_t i = 0; i < effect_count; ++i)
    EXPECT_EQ(on.effect_steps[i], static_cast<Effect>(i) == Effect::reflection ? 2u : 0u) << EFFECT_NAMES[i];
}

// Calls for every effect, each by a triangle, a light or a number of its own.
Scene scene_of_all() {
  Scene scene = make_built_in("terrain:50");
  scene.light.shadows = scene.global_illumination = true;
  scene.occlusion.emplace();
  scene.environment = Environment{.image = {}, .folder = {}, .sky = Sky{}, .origin = "/environment"};
  scene.fog = Fog{.density = 1, .albedo = vec3(1), .anisotropy = 0, .box = {}, .origin = "/fog"};
  scene.more_lights.push_back({.is_point = true, .origin = "/lights/0"});
  scene.lens = {.aperture = 0.1f, .focus = 1, .origin = "/camera/aperture"};
  scene.bounces = 1;
  scene.materials.assign(6, {});
  scene.materials[1].diffuse_map.name = "no such image";
  scene.materials[2].emission = vec3(1);
  scene.materials[3].illum = 3;
  scene.materials[3].specular = vec3(1);
  scene.materials[4].illum = 6;
  scene.materials[4].specular = vec3(1);
  scene.materials[5].opacity = 0.5f;
  for (std::uint32_t i = 0; i < scene.material_index.size(); ++i) scene.material_index[i] = i % 6;
  return scene;
}

// Whether an effect has steps of its own beside the others: with paths all lights are sampled by these, and
// ambient light is not occluded.
bool has_own_steps(Effect effect, const EffectSet& effects) {
  if (!effects.has(effect)) return false;
  return !effects.follows_paths() || (effect != Effect::lights && effect != Effect::ambient_occlusion);
}

// Of none, of each alone and of all pairs.
TEST(PathEffects, NoPictureRecordsOrKeepsWhatIsOff) {
  const Scene scene = scene_of_all();
  std::vector<std::size_t> all(effect_count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const std::size_t i : all) ASSERT_NE(caller(scene, static_cast<Effect>(i)), "") << EFFECT_NAMES[i];
  const auto picture_with = [&](std::size_t first, std::size_t second) {
    std::string changes;
    for (const std::size_t i : all) {
      if (i == first || i == second) continue;
      changes.append(changes.empty() ? "-" : ",-").append(EFFECT_NAMES[i]);
    }
    const EffectSet effects = effects_of(scene, EffectChanges(changes));
    RecordedPicture picture = recorded(scene, changes.c_str());
    for (const std::size_t i : all) {
      EXPECT_EQ(effects.has(static_cast<Effect>(i)), i == first || i == second) << changes;
      EXPECT_EQ(picture.effect_steps[i] > 0, has_own_steps(static_cast<Effect>(i), effects))
          << EFFECT_NAMES[i] << " with " << changes;
    }
    return picture;
  };
  const RecordedPicture none = picture_with(effect_count, effect_count);
  EXPECT_EQ(kernels_of(none), "camera_rays*1 trace_closest*1 shade_pixels*1");
  std::vector<RecordedPicture> alone;
  for (const std::size_t i : all) alone.push_back(picture_with(i, i));
  for (const std::size_t i : all) {
    EXPECT_TRUE(alone[i].device_bytes >= none.device_bytes) << EFFECT_NAMES[i];
    for (std::size_t j = 0; j < i; ++j) {
      const RecordedPicture both = picture_with(i, j);
      EXPECT_GE(both.device_bytes, std::max(alone[i].device_bytes, alone[j].device_bytes))
          << EFFECT_NAMES[i] << " and " << EFFECT_NAMES[j];
    }
  }
}

TEST(PathEffects, AreSaidInTheSceneFile) {
  json file = with_object();
  EXPECT_FALSE(read_scene(file).global_illumination);
  file["global_illumination"] = json::object();
  EXPECT_TRUE(read_scene(file).global_illumination);
  EXPECT_EQ(read_scene(file).bounces, 4u);
  file["global_illumination"]["bounces"] = 7;
  EXPECT_EQ(read_scene(file).bounces, 7u);
  file["materials"]["pane"] = {
      {"filter", {0.5, 1, 0.25}}, {"roughness", 0.25}, {"metallic", 0.75}, {"illum", 6}};
  file["objects"][0]["material"] = "pane";
  const Scene scene = read_scene(file);
  const Material& pane = scene.materials[scene.material_index[0]];
  EXPECT_EQ(pane.filter, glm::vec3(0.5f, 1, 0.25f));
  EXPECT_EQ(pane.roughness, 0.25f);
  EXPECT_EQ(pane.metallic, 0.75f);
}

}  // namespace
}  // namespace coppice
