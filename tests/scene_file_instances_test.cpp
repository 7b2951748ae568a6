// Scene files whose objects are instances.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/instances.h"
#include "support/scene_file_text.h"

namespace coppice {
namespace {

using nlohmann::json;

json instanced_file() {
  json file = with_object({{"translation", {1, 2, 3}}, {"scale", 2}});
  file["materials"] = {{"red", {{"diffuse", {1, 0, 0}}}}};
  file["objects"].push_back(
      {{"mesh", "q"}, {"matrix", {{-1, 0, 0, 4}, {0, 1, 0, 5}, {0, 0, 1, 6}, {0, 0, 0, 1}}}});
  file["objects"].push_back({{"mesh", "t"}, {"material", "red"}});
  file["objects"].push_back({{"name", "above"}, {"translation", {0, 10, 0}}});
  file["objects"].push_back({{"mesh", "t"}, {"parent", "above"}});
  file["instances"] = {{"swarm", {{"seconds", 8}, {"seed", 7}}}};
  return file;
}

// Flattened they are the scene that the same file is without "instances", but for the winding of mirrored
// ones.
TEST(SceneFileInstances, AreTheObjects) {
  json file = instanced_file();
  file["frames_per_second"] = 12;
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.meshes.size(), 3u) << "t, q, and t in red";
  EXPECT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.indices.size(), 4u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[3].mesh);
  ASSERT_TRUE(scene.swarm);
  EXPECT_EQ(scene.swarm->seed, 7u);
  EXPECT_EQ(scene.swarm->seconds, 8);
  EXPECT_EQ(scene.swarm->frames_per_second, 12);
  file.erase("instances");
  const Scene plain = read_scene(file), flat = flattened(scene);
  EXPECT_EQ(flat.positions, plain.positions);
  ASSERT_EQ(flat.indices.size(), plain.indices.size());
  for (std::size_t i = 0; i < flat.indices.size(); ++i) {
    EXPECT_EQ(flat.indices[i].x, plain.indices[i].x);
    EXPECT_EQ(flat.materials[flat.material_index[i]], plain.materials[plain.material_index[i]]) << i;
  }
}

TEST(SceneFileInstances, StandStillWithoutASwarm) {
  json file = instanced_file();
  file["instances"] = json::object();
  const Scene still = read_scene(file);
  EXPECT_EQ(still.instances.size(), 4u);
  EXPECT_FALSE(still.swarm);
  file["objects"] = json::array();
  const Scene none = read_scene(file);
  EXPECT_TRUE(none.instances.empty() && none.indices.empty());
  EXPECT_EQ(none.materials.size(), 1u);
}

// As those without: near the origin, and so that the axis is up.
TEST(SceneFileInstances, MayBeFarAwayAndLie) {
  json file = instanced_file();
  file["camera"] = {{"position", {0, 0, 9}}, {"target", {0, 0, 0}}};
  for (json& object : file["objects"]) {
    if (object.contains("matrix")) {
      object["matrix"][0][3] = 4000004.0;
    } else if (!object.contains("parent")) {
      object["translation"] = {4e6, 2, 3};
    }
  }
  file["up"] = "z";
  const Scene scene = read_scene(file);
  EXPECT_GT(scene.offset.x, 3.9e6);
  ASSERT_TRUE(scene.camera);
  EXPECT_LT(scene.camera->position.x, -3.9e6f);
  file.erase("instances");
  const Scene plain = read_scene(file), flat = flattened(scene);
  ASSERT_EQ(flat.positions.size(), plain.positions.size());
  for (std::size_t v = 0; v < flat.positions.size(); ++v) {
    const glm::dvec3 a = to_file(flat, flat.positions[v]), b = to_file(plain, plain.positions[v]);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], 1e-4) << v;
  }
}

TEST(SceneFileInstances, MoveTogetherOrNotAtAll) {
  const auto error_with = [](const char* pointer, const json& value) {
    json file = instanced_file();
    file[json::json_pointer(pointer)] = value;
    return scene_error_of(file);
  };
  const json track = {{"translation", {{"times", {0}}, {"values", {{1, 1, 1}}}}}};
  EXPECT_EQ(error_with("/objects/2/keyframes", track),
            "s.json: /objects/2/keyframes: does not go with \"instances\"");
  EXPECT_EQ(error_with("/objects/0/deform", {{"kind", "wave"}}),
            "s.json: /objects/0/deform: does not go with \"instances\"");
  EXPECT_EQ(error_with("/duration", 4), "s.json: /duration: does not go with \"instances\"");
  EXPECT_EQ(error_with("/camera", {{"position", {0, 0, 9}},
                                   {"target", {0, 0, 0}},
                                   {"keyframes", {{"fov", {{"times", {0}}, {"values", {40}}}}}}}),
            "s.json: /camera/keyframes: does not go with \"instances\"");
  EXPECT_EQ(error_with("/objects/1/mesh", "walk"),
            "s.json: /objects/1/mesh: \"walk\" moves, with \"instances\" none may");
  EXPECT_EQ(error_with("/objects/2/mesh", "x"),
            "s.json: /objects/2/mesh: no mesh 'x', there are: q, t, walk");
  EXPECT_EQ(error_with("/objects/2/material", "x"),
            "s.json: /objects/2/material: no material 'x', there are: red");
  EXPECT_NE(error_with("/instances", true).find("/instances: true, expected an object"), std::string::npos);
  EXPECT_NE(error_with("/instances/swarm/seconds", 0).find("/instances/swarm/seconds: 0"), std::string::npos);
  EXPECT_NE(error_with("/instances/swarm/seed", -1).find("/instances/swarm/seed: -1"), std::string::npos);
}

}  // namespace
}  // namespace coppice
