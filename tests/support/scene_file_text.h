#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/input_error.h"
#include "scene/motion.h"
#include "scene/scene_file.h"
#include "scene/scene_source.h"

namespace coppice {

// Meshes that are not read from files: "t.obj" is the triangle, "q.obj" a square of two triangles that share
// an edge, "walk.glb" moves by (1, 0, 0) a second for two seconds.
class LineRig : public Rig {
 public:
  Pose pose(double seconds) const override {
    Pose pose;
    pose.joints.emplace_back(1.0f);
    pose.joints[0][3][0] = static_cast<float>(seconds);
    return pose;
  }
};

inline Scene mesh_named(const std::string& path, const GltfReading& reading) {
  Scene scene;
  if (path == "q.obj") {
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.indices = {{0, 1, 2}, {0, 2, 3}};
  } else if (path == "t.obj" || path == "walk.glb") {
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.indices = {{0, 1, 2}};
  } else {
    throw InputError(path + ": no such file");
  }
  if (path == "walk.glb") {
    Motion motion;
    motion.rest = scene.positions;
    motion.rig = std::make_shared<LineRig>();
    motion.duration_seconds = reading.animation ? 5 : 2;
    scene.motion = std::make_shared<Motion>(motion);
    scene.camera = Camera{.position = {0, 0, 9}};
  }
  scene.material_index.assign(scene.indices.size(), 0);
  return scene;
}

inline Scene read_scene(const nlohmann::json& file) {
  SceneFileSources sources;
  sources.mesh = mesh_named;
  sources.built_in = [](const std::string& name) { return make_built_in(name); };
  sources.bytes = [](const std::string& path) -> std::string { throw InputError(path + ": no such file"); };
  return parse_scene_file(file.dump(), "s.json", sources);
}

inline std::string scene_error_of(const nlohmann::json& file) {
  try {
    read_scene(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline nlohmann::json with_object(const nlohmann::json& more = nlohmann::json::object()) {
  nlohmann::json file = {
      {"meshes", {{"t", {{"file", "t.obj"}}}, {"q", {{"file", "q.obj"}}}, {"walk", {{"file", "walk.glb"}}}}},
      {"objects", {{{"mesh", "t"}}}}};
  file["objects"][0].update(more);
  return file;
}

inline void expect_corner(const Scene& scene, std::size_t corner, glm::vec3 expected) {
  ASSERT_LT(corner, scene.positions.size());
  EXPECT_LT(glm::distance(scene.positions[corner], expected), 1e-5f)
      << scene.positions[corner].x << ' ' << scene.positions[corner].y << ' ' << scene.positions[corner].z;
}

inline void expect_corner_at(const Scene& scene, double seconds, std::size_t corner, glm::vec3 expected) {
  ASSERT_TRUE(scene.motion);
  Scene moved = scene;
  moved.positions = positions_at(*scene.motion, seconds);
  expect_corner(moved, corner, expected);
}

}  // namespace coppice
