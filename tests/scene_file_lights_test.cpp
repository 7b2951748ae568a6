// Lights of scene files.
#include <gtest/gtest.h>

#include "support/effect_scenes.h"

namespace coppice {
namespace {

using nlohmann::json;

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
