// What a scene calls for, against the table in docs/effects.md, and what a frame then records.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/effect_scenes.h"

namespace coppice {
namespace {

using nlohmann::json;

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
      "depth_of_field, ambient_occlusion, emission, reflection, refraction, global_illumination, alpha, "
      "environment, fog";
  EXPECT_EQ(error_of("+mist"), "'+mist'" + all);
  EXPECT_EQ(error_of("shadows"), "'shadows'" + all);
  EXPECT_EQ(error_of("+"), "'+'" + all);
  EXPECT_EQ(error_of("+shadows,,+lights"), "''" + all);
  EXPECT_EQ(error_of("+shadows,"), "nothing behind the last comma");
  EXPECT_EQ(error_of(""), "");
}

// --- What is recorded.

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

}  // namespace
}  // namespace coppice
