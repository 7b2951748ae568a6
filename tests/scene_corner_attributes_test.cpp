// Texture coordinates and normals of corners, from files through all that puts scenes together.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "fuzz/scene_complaint.h"
#include "scene/corner_attributes.h"
#include "scene/instances.h"
#include "scene/scene_compose.h"
#include "support/gltf_text.h"
#include "support/obj_folder.h"
#include "support/read_gltf.h"

namespace coppice {
namespace {

constexpr std::uint32_t NONE = NO_ATTRIBUTE;

Scene read_obj(const std::string& text) {
  return parse_obj(text, "a.obj", [](const std::string&, MtlMatch) { return std::nullopt; });
}

const std::string QUAD =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0 7\nvt 1 1\nvt 0 1\nvt 0.5\nvn 0 0 1\nvn 0 0 -2\n";

TEST(CornerAttributes, OfObjFilesWithoutAnyAreNone) {
  const Scene scene = read_obj(QUAD + "f 1 2 3 4\n");
  EXPECT_TRUE(scene.texcoords.empty() && scene.texcoord_index.empty());
  EXPECT_TRUE(scene.normals.empty() && scene.normal_index.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(CornerAttributes, PolygonsKeepThoseOfTheirCorners) {
  // Each corner's numbers are one less than its vertex's, backwards.
  const Scene scene = read_obj(QUAD + "f 1 2 3\nf 1/4/2 2/3/1 3/2/2 4/1/1\nf 1//1 2//2 4\n");
  ASSERT_EQ(scene.indices.size(), 4u);
  ASSERT_EQ(scene.texcoord_index.size(), 4u);
  EXPECT_EQ(scene.texcoord_index[0], glm::uvec3(NONE));
  for (int t = 1; t <= 2; ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(scene.texcoord_index[t][corner], 3 - scene.indices[t][corner]);
      EXPECT_EQ(scene.normal_index[t][corner], (scene.indices[t][corner] + 1) % 2);
    }
  }
  EXPECT_EQ(scene.texcoord_index[3], glm::uvec3(NONE));
  EXPECT_EQ(scene.normal_index[3], glm::uvec3(0, 1, NONE));
  EXPECT_EQ(scene.texcoords[1], glm::vec2(1, 0));
  EXPECT_EQ(scene.texcoords[4], glm::vec2(0.5f, 0));
  EXPECT_EQ(scene.normals[1], glm::vec3(0, 0, -2));
}

// A corner that a polygon has twice keeps both.
TEST(CornerAttributes, ConcavePolygonsThatTouchThemselves) {
  const Scene scene = read_obj(
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\nvt 4 "
      "0\n"
      "vt 5 0\nvt 6 0\nvt 7 0\nvt 8 0\nf 1/1 2/2 3/3 4/4 1/5 5/6 6/7 7/8 5/9\n");
  const std::uint32_t vertices[] = {0, 1, 2, 3, 0, 4, 5, 6, 4};
  ASSERT_EQ(scene.indices.size(), 7u);
  std::vector<bool> seen(9);
  for (std::size_t t = 0; t < 7; ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t at = scene.texcoord_index[t][corner];
      ASSERT_LT(at, 9u);
      EXPECT_EQ(scene.indices[t][corner], vertices[at]);
      seen[at] = true;
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 9);
}

TEST(CornerAttributes, NegativeIndicesCountBack) {
  const Scene scene = read_obj(QUAD + "f -4/-5/-1 -3/-4/-2 -2/1/1\nvt 9 9\nf 1/-1 2/-2 3/-6\n");
  EXPECT_EQ(scene.texcoord_index[0], glm::uvec3(0, 1, 0));
  EXPECT_EQ(scene.normal_index[0], glm::uvec3(1, 0, 0));
  EXPECT_EQ(scene.texcoord_index[1], glm::uvec3(5, 4, 0));
}

TEST(CornerAttributes, OutOfRangeAreNoneAndSaidOnce) {
  const Scene scene = read_obj(QUAD + "f 1/6/1 2/1/3 3/-9/-3\nf 1/0/1 2/x/1 3/2/1\n");
  EXPECT_EQ(scene.texcoord_index[0], glm::uvec3(NONE, 0, NONE));
  EXPECT_EQ(scene.normal_index[0], glm::uvec3(0, NONE, NONE));
  EXPECT_EQ(scene.texcoord_index[1], glm::uvec3(NONE, NONE, 1));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0],
            "a.obj:13: corner whose texture coordinates or normal are not there, it has none; 6 such in all");
}

TEST(CornerAttributes, OfGltfFiles) {
  GltfText text = gltf_triangle();
  nlohmann::json& attributes = text.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = text.floats("VEC2", {0, 0, 1, 0, 0, 2});
  attributes["NORMAL"] = text.floats("VEC3", {0, 0, 1, 0, 0, 1, 1, 0, 1});
  // Mirrored and not evenly scaled: normals go by the transpose of the inverse.
  text.json["nodes"] = {{{"mesh", 0}, {"scale", {-1, 1, 2}}}};
  const Scene scene = read_gltf(text.embedded());
  EXPECT_EQ(complaint_about(scene), "");
  ASSERT_EQ(scene.indices.size(), 1u);
  EXPECT_EQ(scene.indices[0], glm::uvec3(0, 2, 1));
  EXPECT_EQ(scene.texcoord_index[0], glm::uvec3(0, 2, 1));
  EXPECT_EQ(scene.texcoords[2], glm::vec2(0, 2));
  EXPECT_EQ(scene.normal_index[0], glm::uvec3(0, 2, 1));
  EXPECT_EQ(scene.normals[0], glm::vec3(0, 0, 1));
  const glm::vec3 expected = glm::normalize(glm::vec3(-1, 0, 0.5f));
  EXPECT_NEAR(glm::distance(scene.normals[2], expected), 0, 1e-6);
}

TEST(CornerAttributes, OfGltfAnimationsKeepNoNormals) {
  GltfText text = gltf_triangle();
  nlohmann::json& attributes = text.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = text.floats("VEC2", {0, 0, 1, 0, 0, 2});
  attributes["NORMAL"] = text.floats("VEC3", {0, 0, 1, 0, 0, 1, 1, 0, 1});
  const int times = text.floats("SCALAR", {0, 1}), places = text.floats("VEC3", {0, 0, 0, 1, 0, 0});
  text.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", places}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  const Scene scene = read_gltf(text.embedded());
  ASSERT_TRUE(scene.motion);
  EXPECT_TRUE(scene.normals.empty() && scene.normal_index.empty());
  EXPECT_EQ(scene.texcoords.size(), 3u);
}

TEST(CornerAttributes, GltfErrorsNameTheAccessor) {
  GltfText text = gltf_triangle();
  text.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = text.floats("VEC2", {0, 0, 1, 0});
  EXPECT_EQ(gltf_error_of(text.embedded()),
            "t.gltf: /accessors/2/count: 2, expected 3, the number of vertices of /meshes/0/primitives/0");
  text.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 1}, {"NORMAL", 2}};
  text.json["accessors"][2]["count"] = 1;
  text.json["accessors"][2]["type"] = "VEC4";
  EXPECT_NE(gltf_error_of(text.embedded()), "");
}

Scene textured() { return read_obj(QUAD + "f 1/1/1 2/2/1 3/3/1 4/4/1\n"); }

TEST(CornerAttributes, StandUpTurnsNormals) {
  Scene scene = textured();
  stand_up(scene, "z");
  EXPECT_EQ(scene.normals[0], glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.texcoords[2], glm::vec2(1, 1));
}

TEST(CornerAttributes, ComposedScenesKeepThem) {
  Composition composition;
  composition.nodes.nodes.resize(3);
  composition.nodes.parents = {-1, -1, -1};
  composition.nodes.order = {0, 1, 2};
  composition.nodes.nodes[2].is_matrix = true;
  composition.nodes.nodes[2].given = glm::rotate(glm::dmat4(1), glm::radians(90.0), glm::dvec3(1, 0, 0));
  composition.parts.push_back({read_obj(QUAD + "f 1 2 3\n"), 0, {}});
  composition.parts.push_back({textured(), 1, {}});
  composition.parts.push_back({textured(), 2, {}});
  const Scene scene = compose(std::move(composition));
  EXPECT_EQ(complaint_about(scene), "");
  ASSERT_EQ(scene.texcoord_index.size(), 5u);
  EXPECT_EQ(scene.texcoord_index[0], glm::uvec3(NONE));
  for (int t = 1; t < 5; ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 at = scene.positions[scene.indices[t][corner]];
      const glm::vec2 uv = scene.texcoords[scene.texcoord_index[t][corner]];
      EXPECT_NEAR(uv.x, at.x, 1e-6);
      EXPECT_NEAR(uv.y, t < 3 ? at.y : at.z, 1e-6);
      const glm::vec3 expected = t < 3 ? glm::vec3(0, 0, 1) : glm::vec3(0, -1, 0);
      EXPECT_NEAR(glm::distance(scene.normals[scene.normal_index[t][corner]], expected), 0, 1e-6);
    }
  }
}

TEST(CornerAttributes, InstancesKeepThemAndFlattenedTurnNormals) {
  InstanceComposition composition;
  composition.nodes.nodes.resize(2);
  composition.nodes.parents = {-1, -1};
  composition.nodes.order = {0, 1};
  composition.nodes.nodes[1].is_matrix = true;
  composition.nodes.nodes[1].given = glm::rotate(glm::dmat4(1), glm::radians(90.0), glm::dvec3(1, 0, 0));
  composition.meshes = {textured()};
  composition.placed = {{0, 0}, {0, 1}};
  const Scene kept = compose_instances(composition);
  EXPECT_EQ(complaint_about(kept), "");
  EXPECT_EQ(kept.normals[0], glm::vec3(0, 0, 1));
  const Scene flat = flattened(kept);
  EXPECT_EQ(complaint_about(flat), "");
  ASSERT_EQ(flat.texcoord_index.size(), 4u);
  EXPECT_EQ(flat.texcoords[flat.texcoord_index[3].z], flat.texcoords[flat.texcoord_index[1].z]);
  EXPECT_NEAR(glm::distance(flat.normals[flat.normal_index[3].x], glm::vec3(0, -1, 0)), 0, 1e-6);
  EXPECT_EQ(flat.normals[flat.normal_index[0].x], glm::vec3(0, 0, 1));
}

TEST(CornerAttributes, SingularTransformsGiveNormalsStill) {
  // Flattened onto the plane z = 0, which is the surface's.
  const glm::dmat4 onto = glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 0));
  EXPECT_EQ(moved_normal(onto, {0.6f, 0, 0.8f}), glm::vec3(0, 0, 1));
  EXPECT_EQ(moved_normal(glm::dmat4(0), {0.6f, 0, 0.8f}), glm::vec3(0.6f, 0, 0.8f));
  EXPECT_EQ(moved_normal(glm::scale(glm::dmat4(1), glm::dvec3(1, 1, -1)), {0, 0, 1}), glm::vec3(0, 0, -1));
}

}  // namespace
}  // namespace coppice
