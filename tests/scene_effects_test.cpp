// What a scene calls for, against the table in docs/effects.md, and what a frame then records.
#include <gtest/gtest.h>

#include <algorithm>

#include "measure/effects_report.h"
#include "render/frame.h"
#include "scene/effect_set.h"
#include "scene/surface_effects.h"
#include "support/scene_file_text.h"

namespace coppice {
namespace {

using nlohmann::json;

Scene with_lights(const std::vector<json>& lights, const json& light = nullptr) {
  json file = with_object();
  file["lights"] = lights;
  if (!light.is_null()) file["light"] = light;
  return read_scene(file);
}

Scene with_light(const json& light = json::object()) {
  json file = with_object();
  file["light"] = light;
  return read_scene(file);
}

const json sun = {{"direction", {0, 2, 0}}}, lamp = {{"position", {1, 2, 3}}};

json shadowed(json light) {
  light["shadows"] = true;
  return light;
}

// "" where it is off.
std::string caller(const Scene& scene, Effect effect) { return effects_of(scene).of(effect).called_by; }

TEST(Effects, ThePlainSceneCallsForNothing) {
  for (const Scene& scene :
       {Scene{}, make_built_in("grove"), with_light(), with_lights({sun}), with_lights({}),
        with_light({{"direction", {1, 1, 1}}, {"radiance", {1, 2, 3}}})}) {
    EXPECT_EQ(caller(scene, Effect::lights), "");
    EXPECT_EQ(caller(scene, Effect::shadows), "");
    EXPECT_EQ(caller(scene, Effect::textures), "");
    EXPECT_EQ(caller(scene, Effect::alpha), "");
    EXPECT_TRUE(shaded_lights(scene, effects_of(scene)).empty());
  }
}

TEST(Effects, LightsCallForThemByTheirPlaceInTheFile) {
  EXPECT_EQ(caller(with_lights({lamp}), Effect::lights), "/lights/0, a point");
  EXPECT_EQ(caller(with_lights({sun, sun}), Effect::lights), "/lights/1, light number 2");
  EXPECT_EQ(caller(with_lights({sun}, {{"radiance", {1, 1, 1}}}), Effect::lights),
            "/lights/0, light number 2");
  EXPECT_EQ(caller(with_lights({sun, shadowed(sun)}), Effect::shadows), "/lights/1, which casts shadows");
  EXPECT_EQ(caller(with_light({{"shadows", true}}), Effect::shadows), "/light, which casts shadows");
  EXPECT_EQ(caller(with_lights({shadowed(sun)}), Effect::lights), "");
  json dark = shadowed(lamp);
  dark["radiance"] = {0, 0, 0};
  const Scene unlit = with_lights({sun, dark});  // a light that lights nothing calls for nothing
  EXPECT_EQ(caller(unlit, Effect::lights) + caller(unlit, Effect::shadows), "");
}

TEST(Effects, AMapOfColoursThatATriangleHasCallsForTextures) {
  Scene scene = with_light();
  scene.materials = {Material{}, Material{}, Material{}};
  std::ranges::fill(scene.material_index, 0u);
  scene.materials[1].name = "wall";
  scene.materials[1].emission_map.name = "glow.png";
  scene.materials[2].diffuse_map.name = "unused.png";
  scene.materials[0].bump_map.name = "bump.png";  // no colour
  EXPECT_EQ(caller(scene, Effect::textures), "");
  scene.material_index.back() = 1;
  EXPECT_EQ(caller(scene, Effect::textures), "material 'wall', which has glow.png");
  EXPECT_TRUE(effects_of(scene).needs_one_level());
  EXPECT_FALSE(effects_of(scene, EffectChanges("-textures")).needs_one_level());
  EXPECT_FALSE(effects_of(with_light(), EffectChanges("+textures")).needs_one_level());
}

TEST(Effects, AMaterialThatIsNotAllThereCallsForAlpha) {
  const auto caller_of = [](const auto& change) {
    Scene scene = with_light();
    scene.materials.push_back({.name = "unused", .opacity = 0});
    Material& material = scene.materials[scene.material_index[0]];
    material.name = "leaf";
    change(material);
    return caller(scene, Effect::alpha);
  };
  const auto name_of_map = [](Material& m) { m.opacity_map.name = "leaf.png"; };
  EXPECT_EQ(caller_of([](Material&) {}), "");
  EXPECT_EQ(caller_of(name_of_map), "material 'leaf', which has leaf.png");
  EXPECT_EQ(caller_of([](Material& m) { m.opacity = 0.25f; }),
            "material 'leaf', of whose surface 0.25 is there");
  EXPECT_EQ(caller_of([](Material& m) { m.opacity = 0; }), "material 'leaf', of whose surface 0 is there");
  EXPECT_EQ(caller_of([](Material& m) { m.diffuse_map.name = "leaf.png"; }), "") << "whatever its alpha";
  for (const int illum : {4, 6, 7, 9}) {  // glass, of which d is no share
    EXPECT_EQ(caller_of([&](Material& m) { m.opacity = 0.1f, m.illum = illum; }), "") << illum;
    EXPECT_NE(caller_of([&](Material& m) { name_of_map(m), m.illum = illum; }), "") << illum;
  }
  for (const int illum : {0, 1, 2, 3, 5, 8, 10})
    EXPECT_NE(caller_of([&](Material& m) { m.opacity = 0.1f, m.illum = illum; }), "") << illum;
  Scene scene = with_light();
  scene.materials[scene.material_index[0]].opacity = 0.5f;
  EXPECT_TRUE(effects_of(scene).needs_one_level());
  EXPECT_FALSE(effects_of(scene, EffectChanges("-alpha")).needs_one_level());
  EXPECT_FALSE(effects_of(with_light(), EffectChanges("+alpha")).needs_one_level());
}

TEST(Effects, WhatIsShadedHasThoseThatCastShadowsLast) {
  const Scene scene = with_lights({shadowed(lamp), sun, lamp, shadowed(sun)});
  const std::vector<Light> lights = shaded_lights(scene, effects_of(scene));
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].origin, "/lights/1");
  EXPECT_EQ(lights[1].origin, "/lights/2");
  EXPECT_EQ(lights[2].origin, "/lights/0");
  EXPECT_EQ(lights[3].origin, "/lights/3");
  EXPECT_EQ(lights[0].place, glm::vec3(0, 1, 0));
  EXPECT_EQ(lights[2].place, glm::vec3(1, 2, 3));
  const SceneArrays arrays = scene_arrays(scene);
  EXPECT_EQ(arrays.light_counts, (LightCounts{4, 2, true}));
  EXPECT_EQ(arrays.lighting.light_direction, vec3(0)) << "the plain light is one of the list";
}

TEST(Effects, ChangesOverrideWhatTheSceneCallsFor) {
  const auto lights = [](const Scene& scene, const char* changes) {
    std::vector<std::string> text;
    for (const Light& light : shaded_lights(scene, effects_of(scene, EffectChanges(changes))))
      text.push_back(light.origin + (light.shadows ? " shadows" : ""));
    return text;
  };
  using Lines = std::vector<std::string>;
  const Scene plain = with_light(), rich = with_lights({shadowed(sun), lamp});
  EXPECT_EQ(lights(plain, "+shadows"), (Lines{"/light shadows"}));
  EXPECT_EQ(lights(plain, "+lights"), (Lines{"/light"}));
  EXPECT_EQ(lights(Scene{}, "+lights"), (Lines{"the directional light"}));
  EXPECT_EQ(lights(plain, "-shadows,-lights"), Lines{});
  EXPECT_EQ(lights(rich, ""), (Lines{"/lights/1", "/lights/0 shadows"}));
  EXPECT_EQ(lights(rich, "+shadows"), (Lines{"/lights/0 shadows", "/lights/1 shadows"}));
  EXPECT_EQ(lights(rich, "-shadows"), (Lines{"/lights/0", "/lights/1"}));
  EXPECT_EQ(lights(rich, "-lights"), (Lines{"/lights/0 shadows"}));
  EXPECT_EQ(lights(rich, "-lights,-shadows"), Lines{});
  EXPECT_EQ(lights(rich, "-shadows,+shadows"), (Lines{"/lights/0 shadows", "/lights/1 shadows"}));
  const EffectSet off = effects_of(rich, EffectChanges("-shadows"));
  EXPECT_FALSE(off.has(Effect::shadows));
  EXPECT_EQ(off.of(Effect::shadows).called_by, "/lights/0, which casts shadows");
  EXPECT_TRUE(off.of(Effect::shadows).overridden);
}

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

TEST(Effects, WhatEmitsReflectsOrLetsLightThroughCallsForPaths) {
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

TEST(Effects, EmittersTakeThePlaceOfTheDefaultLight) {
  Scene scene = make_built_in("grove");
  scene.materials[scene.material_index[0]].emission = glm::vec3(1);
  EXPECT_TRUE(path_lights(scene, effects_of(scene)).empty());
  EXPECT_EQ(path_lights(scene, effects_of(scene, EffectChanges("-emission"))).size(), 1u);
  scene.light_origin = "/light";
  EXPECT_EQ(path_lights(scene, effects_of(scene)).size(), 1u);
}

TEST(Effects, LightsAreChosenInProportionToTheirPower) {
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

TEST(Effects, ChangesThatNobodyKnowsAreNamed) {
  const auto error_of = [](const char* text) -> std::string {
    try {
      EffectChanges changes(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string all =
      " is no + or - and an effect behind it: there are lights, shadows, textures, "
      "depth_of_field, ambient_occlusion, emission, reflection, refraction, global_illumination, alpha";
  EXPECT_EQ(error_of("+fog"), "'+fog'" + all);
  EXPECT_EQ(error_of("shadows"), "'shadows'" + all);
  EXPECT_EQ(error_of("+"), "'+'" + all);
  EXPECT_EQ(error_of("+shadows,,+lights"), "''" + all);
  EXPECT_EQ(error_of("+shadows,"), "nothing behind the last comma");
  EXPECT_EQ(error_of(""), "");
}

// --- What is recorded.

RecordedPicture recorded(const Scene& scene, const char* changes = "", std::uint32_t samples = 1,
                         Walk walk = Walk::binary) {
  FrameOptions options{.build = BuildOptions{}, .trace = {}};
  options.trace.width = 40;
  options.trace.height = 30;
  options.trace.samples = samples;
  options.trace.walk = walk;
  return recorded_picture(scene_arrays(scene, effects_of(scene, EffectChanges(changes))), options);
}

std::string kernels_of(const RecordedPicture& picture) {
  std::string text;
  for (const RecordedPicture::Kernel& kernel : picture.kernels)
    text += (text.empty() ? "" : " ") + kernel.name + "*" + std::to_string(kernel.dispatches);
  return text;
}

bool has_slot(const RecordedPicture& picture, const std::string& name) {
  return std::ranges::find(picture.slots, name) != picture.slots.end();
}

TEST(Effects, ThePlainSceneRecordsAsIfThereWereNone) {
  const Scene rich = with_lights({shadowed(sun), lamp});
  for (const RecordedPicture& picture :
       {recorded(with_light()), recorded(with_lights({sun})), recorded(rich, no_effects().c_str())}) {
    EXPECT_EQ(kernels_of(picture), "camera_rays*1 trace_closest*1 shade_pixels*1");
    for (const std::uint32_t steps : picture.effect_steps) EXPECT_EQ(steps, 0u);
    for (const char* slot : {"lights", "shadow_marks", "shadow_places", "shadow_scan_status", "shadow_rays",
                             "shadow_count", "shadow_hits", "shadow_counters"}) {
      EXPECT_FALSE(has_slot(picture, slot)) << slot;
    }
  }
}

TEST(Effects, EachRecordsItsStagesAndNoOther) {
  const RecordedPicture plain = recorded(with_light());
  const RecordedPicture lights = recorded(with_lights({sun, lamp}));
  EXPECT_EQ(kernels_of(lights), "camera_rays*1 trace_closest*1 shade*1 shade_lights*1 resolve*1");
  EXPECT_EQ(lights.effect_steps[0], 1u);
  EXPECT_EQ(lights.effect_steps[1], 0u);
  EXPECT_TRUE(has_slot(lights, "lights"));
  EXPECT_FALSE(has_slot(lights, "shadow_rays"));
  const RecordedPicture shadows = recorded(with_lights({shadowed(sun)}));
  EXPECT_EQ(kernels_of(shadows),
            "camera_rays*1 trace_closest*1 shade*1 shadow_marks*1 scan_tile_sums*1 prefix_scan*2 "
            "shadow_rays*1 trace_any*1 shade_lights*1 resolve*1");
  EXPECT_EQ(shadows.effect_steps[0], 0u);
  EXPECT_EQ(shadows.effect_steps[1], 7u);
  const RecordedPicture both = recorded(with_lights({shadowed(sun), lamp, shadowed(lamp)}), "", 3);
  EXPECT_EQ(both.effect_steps[0], 3u);  // the lamp without, once a sample
  EXPECT_EQ(both.effect_steps[1], 2u * 3 * 7);
  EXPECT_GT(lights.device_bytes, plain.device_bytes);
  EXPECT_GT(shadows.device_bytes, lights.device_bytes);
  const RecordedPicture wide = recorded(with_lights({shadowed(sun)}), "", 1, Walk::wide_packets);
  EXPECT_NE(kernels_of(wide).find("trace_wide_any*1"), std::string::npos);
}

TEST(Effects, TexturesRecordOneStageMoreAndOpenNoImageWhereTheyAreOff) {
  Scene scene = with_light();
  scene.materials[scene.material_index[0]].diffuse_map.name = "no such image";
  const RecordedPicture textured = recorded(scene);
  EXPECT_EQ(kernels_of(textured), "camera_rays*1 trace_closest*1 texture_hits*1 shade*1 resolve*1");
  EXPECT_EQ(textured.effect_steps[2], 1u);
  EXPECT_TRUE(has_slot(textured, "texels"));
  EXPECT_EQ(scene_arrays(scene, effects_of(scene)).textures.warnings.size(), 1u);
  const RecordedPicture without = recorded(scene, "-textures");
  EXPECT_EQ(kernels_of(without), "camera_rays*1 trace_closest*1 shade_pixels*1");
  EXPECT_EQ(without.effect_steps[2], 0u);
  for (const char* slot : {"textured_materials", "material_maps", "texture_headers", "texels",
                           "srgb_to_linear", "corners", "hit_materials"}) {
    EXPECT_TRUE(has_slot(textured, slot)) << slot;
    EXPECT_FALSE(has_slot(without, slot)) << slot;
  }
  EXPECT_TRUE(scene_arrays(scene).textures.empty()) << "for trees alone";
}

TEST(Effects, AlphaTakesOtherTracersAndNothingElse) {
  Scene scene = with_lights({shadowed(sun)});
  scene.materials[scene.material_index[0]].opacity = 0.5f;
  const RecordedPicture alpha = recorded(scene, "-shadows");
  EXPECT_EQ(kernels_of(alpha), "camera_rays*1 trace_closest_alpha*1 shade_pixels*1");
  EXPECT_EQ(alpha.effect_steps[9], 1u);
  const RecordedPicture shadows = recorded(scene);
  EXPECT_EQ(kernels_of(shadows),
            "camera_rays*1 trace_closest_alpha*1 shade*1 shadow_marks*1 scan_tile_sums*1 prefix_scan*2 "
            "shadow_rays*1 trace_any_alpha*1 shade_lights*1 resolve*1");
  EXPECT_EQ(shadows.effect_steps[1], 7u);
  EXPECT_EQ(shadows.effect_steps[9], 2u);
  for (const auto& [walk, tracer] : {std::pair{Walk::wide_packets, "trace_wide_alpha*1"},
                                     std::pair{Walk::wide_single, "trace_wide_single_alpha*1"}}) {
    const std::string kernels = kernels_of(recorded(scene, "", 1, walk));
    EXPECT_NE(kernels.find(tracer), std::string::npos) << kernels;
    EXPECT_NE(kernels.find("trace_wide_any_alpha*1"), std::string::npos) << kernels;
  }
  const RecordedPicture without = recorded(scene, "-alpha,-shadows"),
                        forced = recorded(with_light(), "+alpha");
  for (const RecordedPicture& picture : {without, forced}) {
    EXPECT_EQ(kernels_of(picture), "camera_rays*1 trace_closest*1 shade_pixels*1");
    EXPECT_EQ(picture.effect_steps[9], 0u);
    for (const char* slot : {"alpha_triangles", "alpha_maps", "alpha_texels"}) {
      EXPECT_TRUE(has_slot(alpha, slot)) << slot;
      EXPECT_FALSE(has_slot(picture, slot)) << slot;
    }
  }
  EXPECT_GT(alpha.device_bytes, without.device_bytes);
}

TEST(Effects, AnApertureCallsForDepthOfFieldWhichChangesAKernelAndAddsNone) {
  json file = with_object();
  file["camera"] = {{"position", {0, 0, 4}}, {"target", {0, 0, 0}}, {"aperture", 0.25}, {"focus", 3}};
  Scene scene = read_scene(file);
  EXPECT_EQ(caller(scene, Effect::depth_of_field), "/camera/aperture");
  EXPECT_FALSE(effects_of(scene).needs_one_level());
  const RecordedPicture blurred = recorded(scene, "", 2), sharp = recorded(scene, "-depth_of_field", 2);
  EXPECT_EQ(kernels_of(blurred), kernels_of(sharp));
  EXPECT_EQ(blurred.device_bytes, sharp.device_bytes);
  EXPECT_EQ(blurred.effect_steps[3], 2u);
  EXPECT_EQ(sharp.effect_steps[3], 0u);
  const RecordedPicture wide = recorded(scene, "", 1, Walk::wide_packets);
  EXPECT_EQ(kernels_of(wide), "camera_rays*1 trace_wide*1 shade*1 resolve*1");
  EXPECT_EQ(kernels_of(recorded(scene, "-depth_of_field", 1, Walk::wide_packets)), "trace_pixels*1");
  scene.lens.aperture = 0;
  EXPECT_EQ(caller(scene, Effect::depth_of_field), "");
  EXPECT_EQ(kernels_of(recorded(scene, "+depth_of_field", 1, Walk::wide_packets)), "trace_pixels*1")
      << "without an aperture there is nothing to do";
}

TEST(Effects, TheSceneFileCallsForAmbientOcclusion) {
  json file = with_object();
  file["ambient_occlusion"] = {{"distance", 0.5}};
  const Scene scene = read_scene(file);
  EXPECT_EQ(caller(scene, Effect::ambient_occlusion), "/ambient_occlusion");
  EXPECT_TRUE(effects_of(scene).needs_one_level());
  EXPECT_EQ(scene_arrays(scene).light_counts, (LightCounts{1, 0, false, true}));
  const RecordedPicture on = recorded(scene, "", 2), off = recorded(scene, "-ambient_occlusion", 2);
  EXPECT_EQ(kernels_of(on),
            "camera_rays*2 trace_closest*2 shade*2 shade_lights*2 occlusion_marks*2 scan_tile_sums*2 "
            "prefix_scan*4 occlusion_rays*2 trace_any*2 shade_ambient*2 resolve*1");
  EXPECT_EQ(on.effect_steps[0], 0u);
  EXPECT_EQ(on.effect_steps[1], 0u);
  EXPECT_EQ(on.effect_steps[4], 2u * 8) << "the plain light is one of a list";
  EXPECT_EQ(kernels_of(off), "camera_rays*2 trace_closest*2 shade*2 resolve*1");
  EXPECT_EQ(off.effect_steps[4], 0u);
  for (const char* slot : {"ambient_light", "occlusion_counters", "shadow_rays"}) {
    EXPECT_TRUE(has_slot(on, slot)) << slot;
    EXPECT_FALSE(has_slot(off, slot)) << slot;
  }
  EXPECT_FALSE(has_slot(on, "shadow_counters"));
  const RecordedPicture turned_on = recorded(with_light(), "+ambient_occlusion");
  EXPECT_EQ(turned_on.effect_steps[4], 8u);
  const RecordedPicture both = recorded(with_lights({shadowed(sun)}), "+ambient_occlusion");
  EXPECT_EQ(both.effect_steps[1], 7u);
  EXPECT_EQ(both.effect_steps[4], 7u);
  const RecordedPicture shadows = recorded(with_lights({shadowed(sun)}));
  EXPECT_LE(both.device_bytes - shadows.device_bytes, 1024u) << "both take the same queue";
  file["light"] = {{"ambient", {0, 0, 0}}, {"radiance", {1, 1, 1}}};
  const Scene dark = read_scene(file);
  EXPECT_EQ(caller(dark, Effect::ambient_occlusion), "") << "there is nothing to keep off";
  EXPECT_EQ(kernels_of(recorded(dark, "+ambient_occlusion")), kernels_of(recorded(dark)));
}

TEST(Effects, ViewsThatShowNoColoursHaveNone) {
  FrameOptions options{.build = BuildOptions{}, .trace = {}};
  options.trace.width = 40;
  options.trace.height = 30;
  options.trace.show = SHOW_NORMALS;
  Scene scene = with_lights({shadowed(sun), lamp});
  scene.materials[scene.material_index[0]].opacity = 0.5f;
  const RecordedPicture picture = recorded_picture(scene_arrays(scene, effects_of(scene)), options);
  EXPECT_EQ(kernels_of(picture), "camera_rays*1 trace_closest*1 show*1 resolve*1");
  EXPECT_FALSE(has_slot(picture, "lights"));
}

TEST(Effects, ShadowsNeedATreeOfOneLevel) {
  Layout layout;
  FrameOptions options{.build = BuildOptions{}, .trace = {}};
  options.trace.walk = Walk::brute_force;
  EXPECT_THROW(plan_frame(layout, scene_arrays(with_lights({shadowed(sun)})), options),
               std::invalid_argument);
  EXPECT_NO_THROW(plan_frame(layout, scene_arrays(with_lights({sun, lamp})), options));
  Scene occluded = with_light();
  occluded.occlusion = AmbientOcclusion{};
  EXPECT_THROW(plan_frame(layout, scene_arrays(occluded), options), std::invalid_argument);
}

// --- Scene files.

TEST(SceneFileLights, AreReadAndTurnedWithTheFile) {
  json file = with_object();
  file["lights"] = {{{"position", {1, 2, 3}}, {"radiance", {4, 5, 6}}},
                    {{"direction", {0, 0, 5}}, {"shadows", true}},
                    {{"direction", {1, 0, 0}}}};
  file["light"] = {{"ambient", {0.1, 0.2, 0.3}}};
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.ambient_light, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(scene.light.direction, glm::vec3(0, 0, 1)) << "the first directional one is the scene's";
  EXPECT_TRUE(scene.light.shadows);
  EXPECT_EQ(scene.light_origin, "/lights/1");
  ASSERT_EQ(scene.more_lights.size(), 2u);
  EXPECT_TRUE(scene.more_lights[0].is_point);
  EXPECT_EQ(scene.more_lights[0].place, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.more_lights[0].radiance, glm::vec3(4, 5, 6));
  EXPECT_FALSE(scene.more_lights[0].shadows);
  file["up"] = "z";
  const Scene up = read_scene(file);
  EXPECT_EQ(up.light.direction, glm::vec3(0, 1, 0));
  EXPECT_EQ(up.more_lights[0].place, glm::vec3(1, 3, -2));
}

TEST(SceneFileLights, FollowTheSceneIntoRange) {
  json file = with_object({{"scale", 0x1p-40}});
  file["lights"] = {{{"position", {0, 0x1p-40, 0}}}};
  Scene scene = read_scene(file);
  bring_into_range(scene);
  const float scale = std::ldexp(1.0f, scene.scale_exponent);
  EXPECT_GT(scene.scale_exponent, 0);
  EXPECT_EQ(scene.more_lights[0].place, glm::vec3(0, 0x1p-40f * scale, 0));
  EXPECT_EQ(scene.more_lights[0].distance, scale);
}

TEST(SceneFileLights, NoLightAtAllIsSaidAndTheDefaultTaken) {
  const Scene dark = with_lights({}, {{"ambient", {0, 0, 0}}});
  EXPECT_EQ(dark.light.radiance, Scene{}.light.radiance);
  EXPECT_EQ(dark.ambient_light, Scene{}.ambient_light);
  ASSERT_FALSE(dark.warnings.empty());
  EXPECT_EQ(dark.warnings.back(), "s.json: no light at all, the default light is taken");
  EXPECT_TRUE(with_lights({lamp}, {{"ambient", {0, 0, 0}}}).warnings.empty());
}

TEST(SceneFileLights, ErrorsNameTheirPlace) {
  const auto error_of = [](const std::vector<json>& lights) {
    json file = with_object();
    file["lights"] = lights;
    return scene_error_of(file);
  };
  EXPECT_EQ(error_of({sun, {{"radiance", {1, 1, 1}}}}),
            "s.json: /lights/1: expected a \"direction\" or a \"position\", one of both");
  EXPECT_EQ(error_of({{{"direction", {0, 1, 0}}, {"position", {0, 1, 0}}}}),
            "s.json: /lights/0: expected a \"direction\" or a \"position\", one of both");
  EXPECT_EQ(error_of({{{"direction", {0, 0, 0}}}}).substr(0, 40), "s.json: /lights/0/direction: [0,0,0], ex");
  EXPECT_EQ(error_of({{{"position", {0, 0, 1e39}}}}).substr(0, 38), "s.json: /lights/0/position/2: 1e+39, e");
  EXPECT_EQ(error_of({{{"position", {0, 0, 1}}, {"radiance", {-1, 0, 0}}}}).substr(0, 36),
            "s.json: /lights/0/radiance/0: -1, ex");
  EXPECT_EQ(error_of({{{"position", {0, 0, 1}}, {"shadows", "yes"}}}).substr(0, 34),
            "s.json: /lights/0/shadows: \"yes\", ");
  EXPECT_EQ(error_of({{{"position", {0, 0, 1}}, {"colour", 1}}}).substr(0, 39),
            "s.json: /lights/0/colour: unknown key, ");
  EXPECT_EQ(error_of(std::vector<json>(64, sun)).substr(0, 17), "s.json: /lights: ");
  EXPECT_EQ(error_of(std::vector<json>(63, sun)), "");
}

}  // namespace
}  // namespace coppice
