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

json still_file() {
  json file = instanced_file();
  file["instances"] = json::object();
  return file;
}

const json track = {{"translation", {{"times", {0, 4}}, {"values", {{1, 1, 1}, {5, 1, 1}}}}}};

// Those below a node that has keyframes too, and no others.
TEST(SceneFileInstances, MoveByKeyframes) {
  json file = still_file();
  file["objects"][0]["keyframes"] = track;
  file["objects"][3]["keyframes"] = track;  // "above"
  file["up"] = "z";
  const Scene scene = read_scene(file);
  ASSERT_TRUE(scene.motion);
  EXPECT_FALSE(scene.swarm);
  EXPECT_EQ(scene.motion->moved_instances, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(scene.motion->duration_seconds, 4);
  EXPECT_TRUE(scene.motion->rest.empty());
  const std::vector<glm::mat4x3> start = instances_at(*scene.motion, 0),
                                 later = instances_at(*scene.motion, 2);
  ASSERT_EQ(start.size(), 2u);
  EXPECT_EQ(start[0], scene.instances[0].transform);
  EXPECT_EQ(start[1], scene.instances[3].transform);
  EXPECT_EQ(later[0][3], (glm::vec3{3, 1, -1})) << "x goes on, and z is up";
  EXPECT_EQ(standing_at(scene, 2).instances[3].transform, later[1]);
  EXPECT_EQ(standing_at(scene, 2).instances[1].transform, scene.instances[1].transform);
  EXPECT_FALSE(flattened(scene).motion);
  // Without "instances" the same objects are where these are.
  file.erase("instances");
  const Scene plain = read_scene(file);
  const std::vector<glm::vec3> positions = positions_at(*plain.motion, 3),
                               mine = flattened(standing_at(scene, 3)).positions;
  ASSERT_EQ(positions.size(), mine.size());
  for (std::size_t v = 0; v < mine.size(); ++v) EXPECT_LT(glm::length(positions[v] - mine[v]), 1e-5f) << v;
}

// A mesh is kept once with each of its deformations, and moves in its own space.
TEST(SceneFileInstances, MayBeOfMeshesThatMove) {
  json file = still_file();
  file["objects"][0]["deform"] = {{"kind", "wave"}, {"seconds", 3}};
  file["objects"][4]["deform"] = {{"kind", "wave"}, {"seconds", 3}};
  file["objects"][1]["mesh"] = "walk";
  file["objects"].push_back({{"mesh", "t"}});
  const Scene scene = read_scene(file);
  ASSERT_TRUE(scene.motion);
  EXPECT_TRUE(scene.motion->moved_instances.empty());
  EXPECT_EQ(scene.motion->duration_seconds, 3);
  ASSERT_EQ(scene.meshes.size(), 4u) << "waves, walk, t in red, t";
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[3].mesh);
  const InstancedMesh &waves = scene.meshes[0], &walk = scene.meshes[1];
  ASSERT_TRUE(waves.motion && walk.motion);
  EXPECT_FALSE(scene.meshes[2].motion || scene.meshes[3].motion);
  EXPECT_EQ(walk.first_vertex, 3u);
  const Scene later = standing_at(scene, 1);
  EXPECT_EQ(later.positions[3], scene.positions[3] + glm::vec3(1, 0, 0));
  EXPECT_NE(later.positions[1], scene.positions[1]);
  EXPECT_EQ(later.positions[6], scene.positions[6]) << "a mesh that stands still";
  ASSERT_TRUE(scene.camera) << "that of the mesh that walks";
  file["duration"] = 9;
  file["instances"] = {{"swarm", json::object()}};
  EXPECT_EQ(read_scene(file).motion->duration_seconds, 9);
  EXPECT_TRUE(read_scene(file).swarm);
}

// Far from the origin too: what is subtracted from instances is from the camera.
TEST(SceneFileInstances, ACameraMayMoveAlone) {
  json file = still_file();
  for (json& object : file["objects"]) {
    if (object.contains("matrix")) {
      object["matrix"][0][3] = 4000004.0;
    } else if (!object.contains("parent")) {
      object["translation"] = {4e6, 2, 3};
    }
  }
  file["camera"] = {
      {"position", {4e6, 0, 9}},
      {"target", {4e6, 0, 0}},
      {"keyframes", {{"position", {{"times", {0, 2}}, {"values", {{4e6, 0, 9}, {4000002.0, 0, 9}}}}}}}};
  const Scene scene = read_scene(file);
  ASSERT_TRUE(scene.motion);
  EXPECT_TRUE(scene.motion->moved_instances.empty());
  EXPECT_EQ(scene.motion->duration_seconds, 2);
  const std::optional<Camera> start = pose_at(*scene.motion, 0).camera,
                              later = pose_at(*scene.motion, 2).camera;
  ASSERT_TRUE(start && later);
  EXPECT_EQ(start->position, scene.camera->position);
  EXPECT_EQ(later->position, scene.camera->position + glm::vec3(2, 0, 0));
}

TEST(SceneFileInstances, AreRefusedByName) {
  const auto error_with = [](const char* pointer, const json& value) {
    json file = instanced_file();
    file[json::json_pointer(pointer)] = value;
    return scene_error_of(file);
  };
  EXPECT_EQ(error_with("/objects/2/keyframes", track),
            "s.json: /objects/2/keyframes: does not go with a \"swarm\"");
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
