// Scene files: objects, what moves them, cameras and light.
#include "scene/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scene/keyframes.h"
#include "scene/motion.h"
#include "scene/scene_source.h"
#include "scene/view.h"
#include "support/scene_file_text.h"

namespace coppice {
namespace {

using nlohmann::json;

TEST(SceneFiles, ObjectsPlaceMeshes) {
  const Scene plain = read_scene(with_object());
  EXPECT_EQ(plain.motion, nullptr);
  EXPECT_EQ(plain.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  expect_corner(read_scene(with_object({{"translation", {1, 2, 3}}, {"scale", 2}})), 1, {3, 2, 3});
  expect_corner(
      read_scene(with_object({{"scale", {1, 2, 3}}, {"rotation", {{"axis", {0, 0, 5}}, {"degrees", 90}}}})),
      2, {-2, 0, 0});
  expect_corner(read_scene(with_object({{"rotation", {0, 0, 1, 1}}})), 1, {0, 1, 0});
  const Scene mirrored =
      read_scene(with_object({{"matrix", {{-1, 0, 0, 4}, {0, 1, 0, 5}, {0, 0, 1, 6}, {0, 0, 0, 1}}}}));
  expect_corner(mirrored, 1, {3, 5, 6});
  EXPECT_EQ(mirrored.indices, (std::vector<glm::uvec3>{{0, 2, 1}}));
}

TEST(SceneFiles, ParentsMaterialsAndTwoObjects) {
  json file =
      with_object({{"name", "wheel"}, {"parent", "car"}, {"translation", {1, 0, 0}}, {"material", "red"}});
  file["objects"].push_back({{"name", "car"}, {"rotation", {{"axis", {0, 1, 0}}, {"degrees", 180}}}});
  file["objects"].push_back({{"mesh", "q"}});
  file["materials"] = {{"red", {{"diffuse", {1, 0, 0}}, {"opacity", 0.5}}}};
  const Scene scene = read_scene(file);
  expect_corner(scene, 0, {-1, 0, 0});
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}, {3, 5, 6}}));
  EXPECT_EQ(scene.materials[scene.material_index[0]].name, "red");
  EXPECT_EQ(scene.materials[scene.material_index[0]].diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.materials[scene.material_index[0]].opacity, 0.5f);
  EXPECT_EQ(scene.materials[scene.material_index[2]].name, "default");
}

TEST(SceneFiles, KeyframesMoveObjectsAndWhatIsBelowThem) {
  json file = with_object(
      {{"name", "a"},
       {"keyframes",
        {{"translation", {{"times", {1, 3}}, {"values", {{0, 0, 0}, {4, 0, 0}}}}},
         {"rotation", {{"times", {0, 4}}, {"axis", {0, 1, 0}}, {"degrees", {0, 720}}}},
         {"scale", {{"times", {0, 2}}, {"values", {{1, 1, 1}, {2, 2, 2}}}, {"interpolation", "step"}}}}}});
  file["objects"].push_back({{"mesh", "q"}, {"parent", "a"}, {"translation", {0, 0, 1}}});
  file["objects"].push_back({{"mesh", "q"}, {"translation", {7, 0, 0}}});
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.motion->duration_seconds, 4);
  expect_corner(scene, 1, {1, 0, 0});
  expect_corner_at(scene, 1, 1, {-1, 0, 0});  // half a turn
  expect_corner_at(scene, 2, 1, {4, 0, 0});   // 2 along x, a whole turn, twice as large
  expect_corner_at(scene, 9, 0, {4, 0, 0});   // holds
  expect_corner_at(scene, 1, 3, {0, 0, -1});  // below it
  expect_corner_at(scene, 1, 7, {7, 0, 0});   // still
  file["objects"][0]["keyframes"] = {
      {"rotation", {{"times", {0, 1}}, {"values", {{0, 0, 0, 1}, {0, 0, -1, 0}}}}}};
  file["duration"] = 12.5;
  file["frames_per_second"] = 24;
  const Scene turned = read_scene(file);
  expect_corner_at(turned, 0.5, 1, {0, -1, 0});
  EXPECT_EQ(turned.motion->duration_seconds, 12.5);
  EXPECT_EQ(turned.motion->frames_per_second, 24);
}

// Half a unit long, 60 degrees apart: a quarter of the way is 15 degrees, the speed always the same.
TEST(SceneFiles, RotationsNeedNotBeUnitQuaternions) {
  const double c = std::sqrt(0.75) / 2;
  const Keyframes keyframes{
      .is_rotation = true, .width = 4, .times = {0, 1}, .values = {0, 0, 0, 0.5, 0, 0, 0.25, c}};
  for (const double part : {0.25, 0.5, 0.75}) {
    double turned[4];
    sample(keyframes, part, turned);
    EXPECT_NEAR(std::atan2(turned[2], turned[3]), part * std::numbers::pi / 6, 1e-12);
  }
}

// For a sixteenth of a cycle something is where it is at no other time.
TEST(SceneFiles, TheDefaultCameraSeesWhatMovesForAShortTime) {
  const json track = {{"times", {0, 1, 2, 16}}, {"values", {{0, 0, 0}, {0, 50, 0}, {0, 0, 0}, {0, 0, 0}}}};
  Scene scene = read_scene(with_object({{"keyframes", {{"translation", track}}}}));
  ASSERT_FALSE(scene.camera);
  const View view = view_of(frame_scene(scene, 1));
  scene.positions = positions_at(*scene.motion, 1);
  for (const glm::vec3 position : scene.positions) {
    const glm::dvec3 to = glm::dvec3(position) - view.eye;
    const double along = glm::dot(to, view.forward), reach = std::tan(std::numbers::pi / 9) * along;
    EXPECT_GT(along, 0);
    EXPECT_LT(std::abs(glm::dot(to, view.down)), reach) << position.y;
    EXPECT_LT(std::abs(glm::dot(to, view.right)), reach) << position.y;
  }
}

// A cubic curve goes through its values, without a jump in speed.
TEST(SceneFiles, CubicKeyframesAreSmooth) {
  const Scene scene = read_scene(with_object({{"keyframes",
                                               {{"translation",
                                                 {{"times", {0, 1, 3, 4}},
                                                  {"values", {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 0, 0}}},
                                                  {"interpolation", "cubic"}}}}}}));
  const auto at = [&](double seconds) { return glm::dvec3(positions_at(*scene.motion, seconds)[0]); };
  expect_corner_at(scene, 1, 0, {1, 0, 0});
  expect_corner_at(scene, 3, 0, {1, 2, 0});
  for (const double key : {1.0, 3.0}) {
    const glm::dvec3 before = (at(key) - at(key - 1e-2)) / 1e-2, after = (at(key + 1e-2) - at(key)) / 1e-2;
    EXPECT_LT(glm::distance(before, after), 0.1) << key;
  }
  const glm::dvec3 middle = at(2);
  EXPECT_NEAR(middle.y, 1.0 + 2.0 / 8 * (2.0 / 3 - 0),
              1e-5);  // Hermite: (p0 + p1) / 2 + length / 8 (m0 - m1)
}

TEST(SceneFiles, PartsThatMoveByThemselvesGoWithTheirObject) {
  json file = with_object();
  file["objects"][0] = {{"mesh", "walk"}, {"translation", {0, 5, 0}}};
  file["objects"].push_back(
      {{"mesh", "walk"},
       {"keyframes", {{"translation", {{"times", {0, 1}}, {"values", {{0, 0, 0}, {0, 0, 8}}}}}}}});
  const Scene scene = read_scene(file);
  expect_corner_at(scene, 2, 0, {2, 5, 0});
  expect_corner_at(scene, 0.5, 3, {0.5f, 0, 4});
  EXPECT_EQ(scene.motion->duration_seconds, 2);
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(scene.camera->position, glm::vec3(0, 5, 9));
  file["meshes"]["walk"]["animation"] = "run";
  EXPECT_EQ(read_scene(file).motion->duration_seconds, 5);
}

TEST(SceneFiles, DeformationsTakeTheirNumbersFromTheMesh) {
  json file = with_object({{"mesh", "q"}, {"deform", {{"kind", "wave"}, {"amount", 0.5}, {"seconds", 3}}}});
  const Scene wave = read_scene(file);
  ASSERT_TRUE(wave.motion);
  ASSERT_EQ(wave.motion->deformations.size(), 1u);
  EXPECT_EQ(wave.motion->deformations[0].centre, glm::vec3(0.5f, 0.5f, 0));
  EXPECT_EQ(wave.motion->deformations[0].size, 1.0f);
  EXPECT_EQ(wave.motion->deformations[0].amount, 0.5f);
  EXPECT_EQ(wave.motion->duration_seconds, 3);
  EXPECT_EQ(wave.positions, positions_at(*wave.motion, 0));
  EXPECT_NE(wave.positions, positions_at(*wave.motion, 1));
  file["objects"][0]["deform"] = {{"kind", "sway"}, {"size", 4}, {"centre", {1, 2, 3}}};
  EXPECT_EQ(read_scene(file).motion->deformations[0].centre, glm::vec3(1, 2, 3));
  EXPECT_EQ(read_scene(file).motion->deformations[0].kind, DeformKind::sway);
  for (const auto& [name, kind] :
       {std::pair{"explode", DeformKind::explode}, std::pair{"swarm", DeformKind::swarm}}) {
    file["objects"][0]["deform"] = {{"kind", name}, {"piece_triangles", 2}};
    const Scene pieces = read_scene(file);
    EXPECT_EQ(pieces.motion->deformations[0].kind, kind);
    EXPECT_EQ(pieces.motion->deformations[0].piece_vertices, 6u);
    EXPECT_EQ(pieces.positions.size(), 6u);  // no vertex is shared
    EXPECT_EQ(pieces.indices, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}}));
  }
}

TEST(SceneFiles, CamerasAndLight) {
  json file = with_object();
  file["camera"] = {{"position", {0, 1, 5}}, {"target", {0, 0, 0}}, {"fov", 55}};
  file["light"] = {{"direction", {0, 0, 2}}, {"radiance", {3, 2, 1}}, {"ambient", {0.1, 0.2, 0.3}}};
  const Scene still = read_scene(file);
  EXPECT_EQ(still.camera->position, glm::vec3(0, 1, 5));
  EXPECT_EQ(still.camera->vertical_fov_degrees, 55.0f);
  EXPECT_EQ(still.light.direction, glm::vec3(0, 0, 1));
  EXPECT_EQ(still.light.radiance, glm::vec3(3, 2, 1));
  EXPECT_EQ(still.ambient_light, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(still.motion, nullptr);
  file["camera"]["keyframes"] = {{"position", {{"times", {0, 2}}, {"values", {{0, 1, 5}, {4, 1, 5}}}}},
                                 {"fov", {{"times", {0, 4}}, {"values", {40, 60}}}}};
  const Scene moves = read_scene(file);
  ASSERT_TRUE(moves.motion);
  EXPECT_EQ(moves.motion->duration_seconds, 4);
  const Camera camera = *pose_at(*moves.motion, 1).camera;
  EXPECT_EQ(camera.position, glm::vec3(2, 1, 5));
  EXPECT_EQ(camera.vertical_fov_degrees, 45.0f);
  EXPECT_EQ(moves.camera->vertical_fov_degrees, 40.0f);
  file["up"] = "z";
  const Scene up = read_scene(file);
  EXPECT_EQ(up.camera->position, glm::vec3(0, 5, -1));  // z is up
  EXPECT_EQ(up.light.direction, glm::vec3(0, 1, 0));
  EXPECT_LT(glm::distance(pose_at(*up.motion, 1).camera->position, glm::vec3(2, 5, -1)), 1e-6f);
  EXPECT_EQ(up.positions[2], glm::vec3(0, 0, -1));
}

TEST(SceneFiles, FarFromTheOriginAnOffsetIsSubtracted) {
  const Scene scene = read_scene(with_object({{"translation", {1e7, 0, 0}}, {"scale", 0.01}}));
  EXPECT_NE(scene.offset.x, 0);
  EXPECT_NEAR(scene.positions[1].x - scene.positions[0].x, 0.01, 1e-6);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].starts_with("s.json: too far")) << scene.warnings[0];
}

// Those that ship.
TEST(SceneFiles, ScenesThatShipAreRead) {
  std::size_t moving = 0;
  for (const auto& entry : std::filesystem::directory_iterator(COPPICE_SCENES)) {
    const std::string path = entry.path().string();
    if (path.ends_with("schema.json") || (!path.ends_with(".json") && !path.ends_with(".gltf"))) continue;
    const Scene scene = open_scene(path);
    EXPECT_FALSE(scene.indices.empty()) << path;
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    if (!scene.motion) continue;
    EXPECT_EQ(scene.positions, positions_at(*scene.motion, 0)) << path;
    EXPECT_NE(scene.positions, positions_at(*scene.motion, 0.3 * scene.motion->duration_seconds)) << path;
    ++moving;
  }
  EXPECT_GE(moving, 3u);
}

TEST(SceneFiles, TheLensIsOfTheCameraAndFollowsTheScene) {
  json file = with_object({{"scale", 0x1p-40}});
  file["camera"] = {{"position", {0, 0, 0x1p-38}}, {"target", {0, 0, 0}}};
  EXPECT_EQ(read_scene(file).lens.aperture, 0);
  file["camera"]["aperture"] = 0x1p-42;
  file["camera"]["focus"] = 0x1p-39;
  file["ambient_occlusion"] = {{"distance", 0x1p-41}};
  file["up"] = "z";
  Scene scene = read_scene(file);
  EXPECT_EQ(scene.lens.aperture, 0x1p-42f);
  EXPECT_EQ(scene.lens.focus, 0x1p-39f);
  bring_into_range(scene);
  EXPECT_EQ(scene.lens.aperture, std::ldexp(0x1p-42f, scene.scale_exponent));
  EXPECT_EQ(scene.lens.focus, std::ldexp(0x1p-39f, scene.scale_exponent));
  EXPECT_EQ(scene.occlusion.value().distance, std::ldexp(0x1p-41f, scene.scale_exponent));
  set_lens(scene, {.aperture = 0x1p-41, .focus = {}});
  EXPECT_EQ(scene.lens.aperture, std::ldexp(0x1p-41f, scene.scale_exponent));
  EXPECT_EQ(scene.lens.origin, "--aperture");
  EXPECT_TRUE(scene.warnings.empty());
  set_lens(scene, {.aperture = 0, .focus = 1});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "--focus means nothing without an aperture");
  stand_up(scene, "x");
  EXPECT_EQ(scene.lens.focus, 0) << "as there is no camera of the scene's any more";
}

}  // namespace
}  // namespace coppice
