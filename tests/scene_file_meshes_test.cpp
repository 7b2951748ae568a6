// Scene files that name other files: meshes, skins, sequences.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "scene/input_error.h"
#include "scene/motion.h"
#include "scene/scene_file.h"
#include "scene/scene_source.h"
#include "support/gltf_text.h"
#include "support/obj_folder.h"
#include "support/scene_file_text.h"

namespace coppice {
namespace {

using nlohmann::json;
using SceneFile = ObjFolder;
// A skin with a morph target, placed twice, between things that stand still: joints and weights of each are
// its own.
TEST_F(SceneFile, SkinsInSeveralPlaces) {
  const std::string reed_path = std::string(COPPICE_SCENES) + "/reed.gltf";
  const Scene reed = open_scene(reed_path);
  const json file = {
      {"meshes", {{"reed", {{"file", reed_path}}}, {"ball", {{"built_in", "hard:sphere:20"}}}}},
      {"objects",
       {{{"mesh", "ball"}},
        {{"mesh", "reed"}, {"translation", {5, 0, 0}}},
        {{"mesh", "reed"}, {"translation", {0, 0, 7}}, {"scale", {1, 2, -1}}}}}};
  const Scene scene = load_scene_file(write("s.json", file.dump()));
  const std::size_t count = reed.positions.size(), first = scene.positions.size() - 2 * count;
  ASSERT_GT(first, 0u);
  for (const double seconds : {0.0, 0.8, 3.3}) {
    const std::vector<glm::vec3> one = positions_at(*reed.motion, seconds),
                                 all = positions_at(*scene.motion, seconds);
    for (std::size_t v = 0; v < count; ++v) {
      const glm::vec3 p = one[v];
      EXPECT_LT(glm::distance(all[first + v], glm::vec3(p.x + 5, p.y, p.z)), 1e-5f) << v;
      EXPECT_LT(glm::distance(all[first + count + v], glm::vec3(p.x, 2 * p.y, 7 - p.z)), 1e-5f) << v;
    }
  }
  EXPECT_EQ(scene.motion->morphs.size(), 2u);
  EXPECT_NE(scene.motion->morphs[0].weight, scene.motion->morphs[1].weight);
}

TEST_F(SceneFile, FilesBesideItAndSequences) {
  std::filesystem::create_directories(folder_ / "m");
  for (int i = 0; i < 3; ++i) {
    write("m/f_0" + std::to_string(i + 7) + ".obj",
          "v " + std::to_string(i) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  json file = {{"meshes",
                {{"s",
                  {{"sequence", {{"pattern", "m/f_##.obj"}, {"first", 7}, {"last", 9}}},
                   {"frames_per_second", 2},
                   {"interpolate", true},
                   {"start", 1}}}}},
               {"objects", {{{"mesh", "s"}}}}};
  const Scene scene = load_scene_file(write("s.json", file.dump()));
  EXPECT_EQ(scene.name, "s");
  expect_corner_at(scene, 0, 0, {0, 0, 0});
  expect_corner_at(scene, 1.75, 0, {1.5f, 0, 0});
  expect_corner_at(scene, 9, 0, {2, 0, 0});
  EXPECT_EQ(scene.motion->duration_seconds, 2.5);
  file["meshes"]["s"]["sequence"] = {{"files", {"m/f_09.obj", "m/f_07.obj"}}};
  file["meshes"]["s"]["interpolate"] = false;
  expect_corner_at(open_scene(write("s.json", file.dump()).string()), 1.4, 0, {2, 0, 0});
  write("m/f_07.obj", TRIANGLE + "f 1 3 2\n");
  try {
    load_scene_file(folder_ / "s.json");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("s.json: /meshes/s/sequence/files/1: 'm/f_07.obj' has other faces than"),
              std::string::npos)
        << error.what();
  }
}

// A square whose second corner goes in beyond the diagonal along which it was cut; beside it a triangle.
TEST_F(SceneFile, PolygonsOfASequenceAreCutAsThoseOfItsFirstFrame) {
  const std::string rest = "v 1 1 0\nv 0 1 0\nv 5 0 0\n", faces = "f 1 2 3 4\nf 2 5 3\n";
  write("f_0.obj", "v 0 0 0\nv 1 0 0\n" + rest + faces);
  write("f_1.obj", "v 0 0 0\nv 0.2 0.6 0\n" + rest + "f -5 -4 -3 -2\nf 2/1 5/1 3/1\n");
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n";
  write("f_2.ply", head + "property float z\nelement face 2\nproperty list uchar int vertex_indices\n" +
                       "end_header\n0 0 0\n0.1 0.8 0\n1 1 0\n0 1 0\n5 0 0\n4 0 1 2 3\n3 1 4 2\n");
  const std::vector<glm::uvec3> cut = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  ASSERT_EQ(load_mesh_file(folder_ / "f_0.obj").indices, cut);
  ASSERT_NE(load_mesh_file(folder_ / "f_1.obj").indices, cut);
  ASSERT_NE(load_mesh_file(folder_ / "f_2.ply").indices, cut);
  json file = {
      {"meshes",
       {{"s", {{"sequence", {{"files", {"f_0.obj", "f_1.obj", "f_2.ply"}}}}, {"frames_per_second", 1}}}}},
      {"objects", {{{"mesh", "s"}}}}};
  const Scene scene = load_scene_file(write("s.json", file.dump()));
  EXPECT_EQ(scene.indices, cut);
  expect_corner_at(scene, 1, 1, {0.2f, 0.6f, 0});
  expect_corner_at(scene, 2, 1, {0.1f, 0.8f, 0});
  // A face more or less, another corner, another order of faces or of corners, and corners in other faces.
  for (const char* const other : {"f 1 2 3 4\n", "f 1 2 3 4\nf 2 5 4\n", "f 2 5 3\nf 1 2 3 4\n",
                                  "f 2 3 4 1\nf 2 5 3\n", "f 1 2 3\nf 4 2 5 3\n"}) {
    write("f_1.obj", "v 0 0 0\nv 0.2 0.6 0\n" + rest + other);
    try {
      load_scene_file(folder_ / "s.json");
      ADD_FAILURE() << other;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("'f_1.obj' has other faces than 'f_0.obj'"), std::string::npos)
          << error.what();
    }
  }
}

std::string anim_bytes(std::uint32_t magic, std::uint32_t frames) {
  std::string bytes = little_endian(magic) + little_endian(3) + little_endian(frames) + little_endian(1);
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    for (int i = 0; i < 9; ++i) {
      const auto value = static_cast<float>(frame);
      bytes.append(reinterpret_cast<const char*>(&value), 4);
    }
  }
  return bytes;
}

TEST_F(SceneFile, AnimFilesWithTheirFacesBesideThem) {
  write("c_f00.obj", TRIANGLE + "f 1 2 3\n");
  const std::string path = write("c.anim", anim_bytes(0x4d494e41, 4)).string();
  const Scene scene = open_scene(path);
  EXPECT_EQ(scene.name, "c");
  EXPECT_NEAR(scene.motion->duration_seconds, 4 / 30.0, 1e-12);
  expect_corner_at(scene, 2 / 30.0, 1, {2, 2, 2});
  const json file = {
      {"meshes",
       {{"c", {{"anim", "c.anim"}, {"faces", "c_f00.obj"}, {"frames_per_second", 1}, {"repeat", true}}}}},
      {"objects", {{{"mesh", "c"}, {"scale", 2}}}}};
  expect_corner_at(load_scene_file(write("s.json", file.dump())), 5, 0, {2, 2, 2});

  const auto fails = [&](const std::string& bytes, const std::string& says) {
    write("c.anim", bytes);
    try {
      open_scene(path);
      FAIL() << says;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()), path + ": " + says);
    }
  };
  fails(anim_bytes(1, 1), "no .anim file, expected the magic 0x4d494e41");
  fails(anim_bytes(0x4d494e41, 0), "no vertices or no frames, expected some");
  fails(anim_bytes(0x4d494e41, 2).substr(0, 87),
        "87 bytes, expected 16 and 12 for each of 3 vertices in each of 2 frames");
  write("c_f00.obj", TRIANGLE + "f 1 2 3\nf 1 3 2\n");
  fails(anim_bytes(0x4d494e41, 1), "3 vertices and 1 triangles, expected the 3 and 2 of its faces");
  std::filesystem::remove(folder_ / "c_f00.obj");
  fails(anim_bytes(0x4d494e41, 1),
        "holds no faces, expected them in c_f00.obj beside it; a scene file can name another OBJ");
}

}  // namespace
}  // namespace coppice
