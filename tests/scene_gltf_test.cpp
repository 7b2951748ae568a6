// glTF files: how meshes, nodes, materials and cameras are read.
#include <gtest/gtest.h>

#include <fstream>

#include "scene/input_error.h"
#include "scene/load_gltf.h"
#include "scene/motion.h"
#include "support/gltf_text.h"
#include "support/obj_folder.h"
#include "support/read_gltf.h"

namespace coppice {
namespace {

using nlohmann::json;
using LoadGltf = ObjFolder;

const std::vector<glm::vec3> TRIANGLE_CORNERS = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST_F(LoadGltf, ATriangleEmbeddedInAGlbAndInAFileOfItsOwn) {
  GltfText text = gltf_triangle();
  const Scene embedded = load_gltf(write("a.gltf", text.embedded()));
  EXPECT_EQ(embedded.name, "a");
  EXPECT_EQ(embedded.positions, TRIANGLE_CORNERS);
  EXPECT_EQ(embedded.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(embedded.material_index, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(embedded.motion, nullptr);
  EXPECT_TRUE(embedded.warnings.empty());
  EXPECT_EQ(load_gltf(write("b.glb", text.binary())).positions, TRIANGLE_CORNERS);

  text.json["buffers"] = {{{"byteLength", text.bytes.size()}, {"uri", "my%20bytes.bin"}}};
  write("my bytes.bin", text.bytes + "more");
  EXPECT_EQ(load_gltf(write("c.gltf", text.json.dump())).positions, TRIANGLE_CORNERS);
  std::filesystem::remove(folder_ / "my bytes.bin");
  try {
    load_gltf(folder_ / "c.gltf");
    FAIL() << "a file is missing";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("c.gltf: /buffers/0/uri: "), what.npos) << what;
    EXPECT_NE(what.find("my bytes.bin: no such file"), what.npos) << what;
  }
}

TEST(Gltf, StripsFansAndVerticesWithoutIndices) {
  GltfText text;
  text.json["nodes"] = {{{"mesh", 0}}};
  const int positions = text.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0, 3, 3, 0, 4, 4, 0});
  const auto triangles = [&](int mode) {
    text.json["meshes"] = {{{"primitives", {{{"mode", mode}, {"attributes", {{"POSITION", positions}}}}}}}};
    return read_gltf(text.embedded());
  };
  using Triangles = std::vector<glm::uvec3>;
  EXPECT_EQ(triangles(4).indices, (Triangles{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(triangles(5).indices, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}, {4, 5, 6}}));
  EXPECT_EQ(triangles(6).indices, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}, {5, 6, 0}}));
  for (int mode = 0; mode < 4; ++mode) {
    const Scene lines = triangles(mode);
    EXPECT_TRUE(lines.indices.empty());
    ASSERT_EQ(lines.warnings.size(), 2u);
    EXPECT_EQ(lines.warnings[0], "t.gltf: /meshes/0/primitives/0/mode: lines and points are not drawn");
    EXPECT_EQ(lines.warnings[1], "t.gltf: no triangles");
  }
}

// Bytes, shorts and words as indices; positions as integers, normalised or not, and interleaved.
TEST(Gltf, EveryComponentType) {
  GltfText text = gltf_triangle();
  const auto primitive = [&]() -> json& { return text.json["meshes"][0]["primitives"][0]; };
  const auto accessor = [&](int view, int component_type, const char* type, bool normalized) {
    return text.accessor({{"bufferView", view},
                          {"componentType", component_type},
                          {"count", 3},
                          {"type", type},
                          {"normalized", normalized}});
  };
  for (const int indices : {accessor(text.view<std::uint8_t>({2, 1, 0}), 5121, "SCALAR", false),
                            accessor(text.view<std::uint16_t>({2, 1, 0}), 5123, "SCALAR", false),
                            accessor(text.view<std::uint32_t>({2, 1, 0}), 5125, "SCALAR", false)}) {
    primitive()["indices"] = indices;
    EXPECT_EQ(read_gltf(text.embedded()).indices, (std::vector<glm::uvec3>{{2, 1, 0}}));
  }
  const int words = text.view<std::uint32_t>({1, 2, 3, 4, 5, 6, 7, 8, 9});
  const int shorts = text.view<std::int16_t>({-32768, 32767, 0, 0, -32767, 7, 0, 0, 1, 2, 3, 0});
  text.json["bufferViews"][static_cast<std::size_t>(shorts)]["byteStride"] = 8;
  const int bytes = text.view<std::int8_t>({-128, 127, 0, 0, -127, 7, 0, 0, 1, 2, 3, 0});
  text.json["bufferViews"][static_cast<std::size_t>(bytes)]["byteStride"] = 4;
  const int unsigned_bytes = text.view<std::uint8_t>({255, 0, 51, 0, 1, 2, 3, 0, 4, 5, 6, 0});
  text.json["bufferViews"][static_cast<std::size_t>(unsigned_bytes)]["byteStride"] = 4;
  const int unsigned_shorts = text.view<std::uint16_t>({65535, 0, 13107, 0, 1, 2, 3, 0, 4, 5, 6, 0});
  text.json["bufferViews"][static_cast<std::size_t>(unsigned_shorts)]["byteStride"] = 8;
  struct Case {
    int view, type;
    bool normalized;
    glm::vec3 first;
  };
  for (const auto& [view, type, normalized, first] :
       {Case{words, 5125, false, {1, 2, 3}}, Case{shorts, 5122, false, {-32768, 32767, 0}},
        Case{shorts, 5122, true, {-1, 1, 0}}, Case{bytes, 5120, false, {-128, 127, 0}},
        Case{bytes, 5120, true, {-1, 1, 0}}, Case{unsigned_bytes, 5121, false, {255, 0, 51}},
        Case{unsigned_bytes, 5121, true, {1, 0, 0.2f}}, Case{unsigned_shorts, 5123, false, {65535, 0, 13107}},
        Case{unsigned_shorts, 5123, true, {1, 0, 0.2f}}}) {
    primitive()["attributes"]["POSITION"] = accessor(view, type, "VEC3", normalized);
    const Scene scene = read_gltf(text.embedded());
    ASSERT_EQ(scene.positions.size(), 3u);
    EXPECT_EQ(scene.positions[0], first) << type << normalized;
  }
}

TEST(Gltf, SparseAccessorsWithAndWithoutAView) {
  GltfText text = gltf_triangle();
  const json sparse = {
      {"count", 2},
      {"indices", {{"bufferView", text.view<std::uint8_t>({0, 2})}, {"componentType", 5121}}},
      {"values", {{"bufferView", text.view<float>({7, 8, 9, 4, 5, 6})}}}};
  text.json["accessors"][1]["sparse"] = sparse;
  EXPECT_EQ(read_gltf(text.embedded()).positions, (std::vector<glm::vec3>{{7, 8, 9}, {1, 0, 0}, {4, 5, 6}}));
  text.json["accessors"][1].erase("bufferView");
  EXPECT_EQ(read_gltf(text.embedded()).positions, (std::vector<glm::vec3>{{7, 8, 9}, {0, 0, 0}, {4, 5, 6}}));
}

TEST(Gltf, NodesPlaceMeshesAndMirrorsTurnTrianglesRound) {
  GltfText text = gltf_triangle();
  text.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {1}}}};
  text.json["scene"] = 1;
  const double half = std::sqrt(0.5);
  text.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}},
                        {{"children", {0, 3}},
                         {"rotation", {0, 0, half, half}},
                         {"scale", {2, 3, 4}},
                         {"translation", {10, 0, 0}}},
                        {{"mesh", 0}},
                        {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}};
  const Scene scene = read_gltf(text.embedded());
  ASSERT_EQ(scene.positions.size(), 6u);
  // (x, y, z) becomes (10 - 3 y, 2 x, 4 z).
  const std::vector<glm::vec3> expected = {{10, 2, 0},  {10, 4, 0},   {7, 2, 0},
                                           {10, 0, 20}, {10, -2, 20}, {7, 0, 20}};
  for (std::size_t v = 0; v < 6; ++v) {
    EXPECT_LT(glm::distance(scene.positions[v], expected[v]), 1e-5f) << v;
  }
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 5, 4}}));
  text.json.erase("scene");  // the first one
  EXPECT_EQ(read_gltf(text.embedded()).positions, TRIANGLE_CORNERS);
  text.json.erase("scenes");  // all nodes
  EXPECT_EQ(read_gltf(text.embedded()).indices.size(), 3u);
}

TEST(Gltf, MaterialsInTermsOfMtl) {
  GltfText text = gltf_triangle();
  text.json["meshes"][0]["primitives"][0]["material"] = 0;
  text.json["textures"] = {{{"source", 0}}};
  text.json["images"] = {{{"uri", "wood.png"}}};
  text.json["materials"] = {
      {{"name", "wood"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 0.125, 0.75}},
         {"metallicFactor", 0},
         {"roughnessFactor", 0.5},
         {"baseColorTexture", {{"index", 0}}}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "BLEND"},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
         {"KHR_materials_ior", {{"ior", 1.25}}}}}},
      {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}},
      {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}},
      {{"extensions", {{"KHR_materials_unlit", json::object()}}},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 0, 1}}}}}};
  const Scene scene = read_gltf(text.embedded());
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{1}));
  ASSERT_EQ(scene.materials.size(), 5u);
  const Material& wood = scene.materials[1];
  EXPECT_EQ(wood.name, "wood");
  EXPECT_EQ(wood.diffuse, glm::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(wood.specular, glm::vec3(0.04f));
  EXPECT_EQ(wood.shininess, 30.0f);  // 2 / 0.5^4 - 2
  EXPECT_EQ(wood.emission, glm::vec3(4, 2, 0));
  EXPECT_EQ(wood.opacity, 0.75f);
  EXPECT_EQ(wood.index_of_refraction, 1.25f);
  EXPECT_EQ(wood.illum, 2);
  EXPECT_EQ(wood.diffuse_map.name, "wood.png");
  EXPECT_EQ(scene.materials[2].opacity, 0.25f);
  EXPECT_EQ(scene.materials[2].illum, 7);
  EXPECT_EQ(scene.materials[3].opacity, 0.0f);
  EXPECT_EQ(scene.materials[3].illum, 3);  // metals are the default
  EXPECT_EQ(scene.materials[4].emission, glm::vec3(0.5f, 1, 0));
  EXPECT_EQ(scene.materials[4].diffuse, glm::vec3(0));
  EXPECT_TRUE(scene.materials[4].is_unlit);
  EXPECT_FALSE(wood.is_unlit);
  EXPECT_EQ(wood.filter, wood.diffuse);
}

TEST(Gltf, TheFirstPerspectiveCameraOfTheScene) {
  GltfText text = gltf_triangle();
  text.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  const double half = std::sqrt(0.5);
  text.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  text.json["nodes"] = {{{"mesh", 0}},
                        {{"camera", 0}},
                        {{"camera", 1}, {"translation", {-5, 0, 0}}, {"rotation", {0, -half, 0, half}}}};
  const Scene scene = read_gltf(text.embedded());
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(scene.camera->position, glm::vec3(-5, 0, 0));
  EXPECT_NEAR(scene.camera->target.x, 0.5, 1e-5);  // as far as the middle
  EXPECT_NEAR(scene.camera->target.z, 0, 1e-5);
  EXPECT_LT(glm::distance(scene.camera->up, glm::vec3(0, 1, 0)), 1e-6f);
  EXPECT_NEAR(scene.camera->vertical_fov_degrees, 28.6479, 1e-4);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "t.gltf: /cameras/0: orthographic cameras are not used");
}

TEST(Gltf, FarFromTheOriginAnOffsetIsSubtracted) {
  GltfText text = gltf_triangle();
  text.json["nodes"][0]["translation"] = {5000000.125, 0, 0};
  const Scene scene = read_gltf(text.embedded());
  EXPECT_NE(scene.offset.x, 0);
  EXPECT_EQ(scene.positions[1].x - scene.positions[0].x, 1.0f);
  EXPECT_EQ(to_file(scene, scene.positions[0]), glm::dvec3(5000000.125, 0, 0));
}

}  // namespace
}  // namespace coppice
