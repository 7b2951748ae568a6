#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <limits>
#include <string>

#include "scene/generators.h"
#include "scene/hard_cases.h"
#include "scene/input_error.h"
#include "scene/scene_source.h"
#include "support/scenes.h"

namespace coppice {
namespace {

Scene one_triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  Scene scene;
  scene.positions = {a, b, c};
  scene.indices = {{0, 1, 2}};
  scene.material_index = {0};
  return scene;
}

TEST(Grove, IsTheSameEveryTimeAndWorthLookingAt) {
  const Scene scene = make_grove();
  EXPECT_TRUE(same_bits(scene, make_grove()));
  expect_consistent(scene);
  EXPECT_EQ(count_inactive(scene), 0u);
  EXPECT_GE(scene.indices.size(), 100'000u);
  EXPECT_LE(scene.indices.size(), 220'000u);
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(frame_scene(scene, 1.5f).position, scene.camera->position);
  const glm::vec3 light = scene.light.direction;
  EXPECT_NEAR(light.x * light.x + light.y * light.y + light.z * light.z, 1, 1e-5);
}

class GeneratedCount : public testing::TestWithParam<std::uint32_t> {};

TEST_P(GeneratedCount, ScatterIsExact) {
  const Scene scene = make_scatter(GetParam());
  EXPECT_EQ(scene.indices.size(), GetParam());
  expect_consistent(scene);
  EXPECT_EQ(count_inactive(scene), 0u);
}

TEST_P(GeneratedCount, TerrainIsExact) {
  const Scene scene = make_terrain(GetParam());
  EXPECT_EQ(scene.indices.size(), GetParam());
  expect_consistent(scene);
  EXPECT_EQ(count_inactive(scene), 0u);
}

INSTANTIATE_TEST_SUITE_P(Sizes, GeneratedCount,
                         testing::Values(0, 1, 2, 3, 4, 5, 7, 31, 32, 33, 1000, 4097, 100'003));

TEST(Scatter, IsAFunctionOfCountAndSeed) {
  EXPECT_TRUE(same_bits(make_scatter(5000, 3), make_scatter(5000, 3)));
  EXPECT_FALSE(same_bits(make_scatter(5000, 3), make_scatter(5000, 4)));
}

TEST(Terrain, IsConnected) {
  const Scene scene = make_terrain(2000);
  EXPECT_LT(scene.positions.size(), 1200u);
}

TEST(FrameScene, SeesEveryCornerOfTheScene) {
  const Scene scene = one_triangle({-3, 0, 0}, {5, 1, 2}, {0, 7, -4});
  for (const float aspect : {0.5f, 1.0f, 2.0f}) {
    const Camera camera = frame_scene(scene, aspect);
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const float tan_y = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    for (const glm::vec3 p : scene.positions) {
      const glm::vec3 d = p - camera.position;
      const float depth = glm::dot(d, forward);
      EXPECT_GT(depth, 0);
      EXPECT_LT(std::abs(glm::dot(d, up)), depth * tan_y);
      EXPECT_LT(std::abs(glm::dot(d, right)), depth * tan_y * aspect);
    }
  }
}

TEST(FrameScene, WorksWithoutAnythingToSee) {
  constexpr float MAX = std::numeric_limits<float>::max();
  constexpr float LEAST = std::numeric_limits<float>::denorm_min();
  expect_usable_camera(Scene{});
  expect_usable_camera(one_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
  expect_usable_camera(one_triangle({1e6f, 1, 1}, {1e6f, 1, 1}, {1e6f, 1, 1}));
  expect_usable_camera(one_triangle(glm::vec3{MAX}, glm::vec3{MAX}, glm::vec3{MAX}));
  expect_usable_camera(one_triangle(glm::vec3{-MAX}, glm::vec3{MAX}, glm::vec3{0}));
  expect_usable_camera(one_triangle(glm::vec3{LEAST}, glm::vec3{0}, glm::vec3{-LEAST}));
  expect_usable_camera(one_triangle({NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, 0}));
}

TEST(FrameScene, IgnoresInactiveTriangles) {
  Scene scene = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Camera expected = frame_scene(scene, 1);
  scene.positions.insert(scene.positions.end(), {{900, 900, 900}, {NAN, 0, 0}, {1, 2, 3}});
  scene.indices.emplace_back(3, 4, 5);
  scene.material_index.push_back(0);
  EXPECT_EQ(frame_scene(scene, 1).position, expected.position);
}

std::string error_of(const std::string& spec) {
  try {
    open_scene(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OpenScene, OpensEverythingThatIsListed) {
  std::vector<SceneListing> listings = list_scenes();
  ASSERT_FALSE(listings.empty());
  EXPECT_EQ(listings[0].name, "grove");
  const std::vector<SceneListing> hard_listings = list_hard_scenes();
  EXPECT_EQ(hard_listings.size(), hard_cases().size());
  listings.insert(listings.end(), hard_listings.begin(), hard_listings.end());
  for (const SceneListing& listing : listings) {
    const Scene scene = open_scene(listing.name);
    EXPECT_EQ(scene.indices.size(), listing.triangles) << listing.name;
    EXPECT_FALSE(scene.name.empty());
    EXPECT_FALSE(listing.description.empty());
    if (!listing.takes_count) continue;
    const bool of_instances = listing.name == "instances";
    const Scene twenty = open_scene(listing.name + ":20", "y", true);
    EXPECT_EQ(of_instances ? twenty.instances.size() : twenty.indices.size(), 20u) << listing.name;
  }
}

TEST(OpenScene, NamesTheSceneWithItsSize) {
  EXPECT_EQ(open_scene("scatter:12").name, "scatter:12");
  EXPECT_EQ(open_scene("hard:far:12").name, "hard:far:12");
}

TEST(OpenScene, AHardCaseTakesASeed) {
  const HardCase& far_outlier = *find_hard_case("one-cell");
  EXPECT_TRUE(same_bits(open_scene("hard:one-cell:50"), far_outlier.make(50, 1)));
  EXPECT_TRUE(same_bits(open_scene("hard:one-cell:50:1"), far_outlier.make(50, 1)));
  EXPECT_TRUE(same_bits(open_scene("hard:one-cell:50:0"), far_outlier.make(50, 0)));
  EXPECT_TRUE(same_bits(open_scene("hard:one-cell:50:18446744073709551615"), far_outlier.make(50, ~0ull)));
  EXPECT_FALSE(same_bits(far_outlier.make(50, 0), far_outlier.make(50, 1)));
}

TEST(OpenScene, ASeedThatIsNoneIsAnError) {
  for (const std::string seed : {"", "-1", "x", "1.5", "0x1", "1:2", "18446744073709551616"}) {
    EXPECT_EQ(error_of("hard:nested:5:" + seed),
              "scene 'hard:nested:5:" + seed + "': '" + seed + "' is no seed from 0 to 18446744073709551615");
  }
  EXPECT_EQ(error_of("hard:nested::5"),
            "scene 'hard:nested::5': '' is no number of triangles from 1 to 67107840");
}

TEST(OpenScene, OpensAFile) {
  const auto path = std::filesystem::path(testing::TempDir()) / "coppice_open_scene.OBJ";
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(open_scene(path.string()).indices.size(), 1u);
  std::filesystem::remove(path);
}

TEST(OpenScene, AnUnknownNameIsAnError) {
  EXPECT_EQ(error_of("foo"),
            "unknown scene 'foo': neither a file nor a built-in scene (see 'coppice scenes')");
  EXPECT_EQ(error_of(""), "unknown scene '': neither a file nor a built-in scene (see 'coppice scenes')");
  EXPECT_TRUE(error_of("hard:foo").starts_with("unknown hard case 'foo': there are coincident, "));
  EXPECT_TRUE(error_of("hard:").starts_with("unknown hard case ''"));
}

TEST(OpenScene, ACountThatIsNoneIsAnError) {
  for (const std::string count : {"0", "-1", "x", "", "1.5", "12x", "67108865", "99999999999"}) {
    for (const std::string name : {"scatter", "terrain", "hard:nested"}) {
      EXPECT_EQ(error_of(name + ":" + count), "scene '" + name + ":" + count + "': '" + count +
                                                  "' is no number of triangles from 1 to 67107840");
    }
  }
  EXPECT_NE(error_of("grove:5"), "");
}

TEST(OpenScene, AFileThatIsNoSceneIsAnError) {
  EXPECT_EQ(error_of("none.obj"), "none.obj: no such file");
  EXPECT_EQ(error_of("none.ply"), "none.ply: no such file");
  EXPECT_EQ(error_of("none/none"), "none/none: no such file");
  const std::filesystem::path folder = testing::TempDir();
  EXPECT_EQ(error_of(folder.string()), folder.string() + ": is a directory, not a scene file");
  const auto path = folder / "coppice_open_scene.stl";
  std::ofstream(path) << "solid\n";
  EXPECT_EQ(error_of(path.string()),
            path.string() +
                ": unknown extension '.stl', scene files end in .obj, .gltf, .glb, .ply, .json or .anim");
  std::filesystem::remove(path);
}

TEST(BuiltInSize, IsKnownBeforeTheSceneIsMade) {
  for (const char* spec : {"scatter:1234", "terrain:777", "terrain:1", "hard:sphere:1001",
                           "hard:needles:77:5", "hard:repeated-positions:300"}) {
    const auto size = built_in_size(spec);
    ASSERT_TRUE(size) << spec;
    const Scene scene = open_scene(spec);
    EXPECT_EQ(size->triangles, scene.indices.size()) << spec;
    if (!std::string_view(spec).starts_with("terrain")) {
      EXPECT_LE(scene.positions.size(), size->vertices) << spec;
    }
  }
  EXPECT_EQ(built_in_size("scatter:" + std::to_string(MAX_GENERATED_TRIANGLES))->triangles,
            MAX_GENERATED_TRIANGLES);
  for (const char* spec : {"grove", "some.obj", "nonsense"}) EXPECT_FALSE(built_in_size(spec)) << spec;
}

TEST(BuiltInSize, CountsBeyondABuildAreRefusedBeforeAnythingIsMade) {
  const std::string more = std::to_string(MAX_GENERATED_TRIANGLES + 1);
  for (const std::string& spec : {"scatter:" + more, "terrain:" + more, "hard:points:" + more,
                                  std::string("scatter:99999999999999999999"), std::string("terrain:-1"),
                                  std::string("scatter:"), std::string("hard:points:3:x")}) {
    EXPECT_THROW(built_in_size(spec), InputError) << spec;
    EXPECT_THROW(open_scene(spec), InputError) << spec;
  }
}

}  // namespace
}  // namespace coppice
