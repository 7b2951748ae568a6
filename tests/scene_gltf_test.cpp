// glTF files: how meshes, nodes, materials and cameras are read.
#include <gtest/gtest.h>

#include <fstream>

#include "scene/input_error.h"
#include "scene/load_gltf.h"
#include "scene/motion.h"
#include "support/gltf_text.h"
#include "support/obj_folder.h"

namespace coppice {
namespace {

using nlohmann::json;
using LoadGltf = ObjFolder;

Scene read_gltf(const std::string& text, const GltfReading& reading = {}) {
  return parse_gltf(
      text, "t.gltf", [](const std::string&) -> std::string { throw InputError("no such file"); }, reading);
}

std::string gltf_error_of(const std::string& text, const GltfReading& reading = {}) {
  try {
    read_gltf(text, reading);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

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
  EXPECT_EQ(wood.diffuse_map, "wood.png");
  EXPECT_EQ(scene.materials[2].opacity, 0.25f);
  EXPECT_EQ(scene.materials[2].illum, 7);
  EXPECT_EQ(scene.materials[3].opacity, 0.0f);
  EXPECT_EQ(scene.materials[3].illum, 3);  // metals are the default
  EXPECT_EQ(scene.materials[4].emission, glm::vec3(0.5f, 1, 0));
  EXPECT_EQ(scene.materials[4].diffuse, glm::vec3(0));
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

struct Fault {
  const char* pointer;  // where the file is changed
  json value;           // null: taken out
  const char* says;     // part of the message
};

TEST(Gltf, EveryErrorNamesItsPlaceAndWhatWasExpected) {
  const std::vector<Fault> faults = {
      {"/asset/version", "1.0", "/asset/version: \"1.0\", expected \"2.0\""},
      {"/asset", nullptr, "key \"asset\" is missing"},
      {"/scene", 3, "/scene: 3, expected an index below 1, the number of scenes"},
      {"/scene", -1, "/scene: -1, expected an index"},
      {"/scene", "a", "/scene: \"a\", expected an index"},
      {"/scenes/0/nodes/0", 7, "/scenes/0/nodes/0: 7, expected an index below 2, the number of nodes"},
      {"/scenes/0/nodes", {1}, "/scenes/0/nodes/0: node 1 is a child of node 0"},
      {"/scenes/0/nodes", {0, 0}, "/scenes/0/nodes/1: node 0 twice"},
      {"/nodes/0/children/0", 9, "/nodes/0/children/0: 9, expected an index below 2"},
      {"/nodes/0/children", {0}, "/nodes/0/children: the node is below itself (a cycle)"},
      {"/nodes/1/children", {0}, "/nodes/0/children: the node is below itself (a cycle)"},
      {"/nodes/0/children", {1, 1}, "/nodes/0/children/1: node 1 is a child of node 0 already"},
      {"/nodes/0/mesh", 1, "/nodes/0/mesh: 1, expected an index below 1, the number of meshes"},
      {"/nodes/0/skin", 0, "/nodes/0/skin: 0, expected an index below 0, the number of skins"},
      {"/nodes/0/camera", 0, "/nodes/0/camera: 0, expected an index below 0, the number of cameras"},
      {"/nodes/0/translation", {1, 2}, "/nodes/0/translation: [1,2], expected an array of 3, each a number"},
      {"/nodes/0/translation", {1, 2, "c"}, "/nodes/0/translation/2: \"c\", expected a number"},
      {"/nodes/0/matrix", {1}, "/nodes/0/matrix: [1], expected an array of 16"},
      {"/meshes/0/primitives", nullptr, "/meshes/0: key \"primitives\" is missing"},
      {"/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode: 7, expected an integer from 0 to 6"},
      {"/meshes/0/primitives/0/material", 0,
       "/material: 0, expected an index below 0, the number of materials"},
      {"/meshes/0/primitives/0/indices", 5, "/meshes/0/primitives/0/indices: 5, expected an index below 2"},
      {"/meshes/0/primitives/0/indices", 1, "/accessors/1/componentType: 5126, expected 5121, 5123 or 5125"},
      {"/meshes/0/primitives/0/attributes/POSITION", 0, "/accessors/0/type: \"SCALAR\", expected \"VEC3\""},
      {"/accessors/0/count", 0, "/accessors/0/count: 0, expected an integer from 1"},
      {"/accessors/1/count", 4, "/accessors/1/count: 4, expected at most 3"},
      {"/accessors/1/count", 4000000000000, "/accessors/1/count: 4000000000000, expected at most 3"},
      {"/accessors/1/count", 1.5, "/accessors/1/count: 1.5, expected an integer"},
      {"/accessors/1/count", 2, "/accessors/0: index 2 is 2, expected one below 2"},
      {"/accessors/1/byteOffset", 4, "/accessors/1/count: 3, expected at most 2"},
      {"/accessors/1/byteOffset", 9007199254740991, "/accessors/1/count: 3, expected at most 0"},
      {"/accessors/1/bufferView", 9, "/accessors/1/bufferView: 9, expected an index below 2"},
      {"/accessors/1/type", "VEC5", "/accessors/1/type: \"VEC5\", expected \"SCALAR\", \"VEC2\""},
      {"/accessors/1/componentType", 5124, "/accessors/1/componentType: 5124, expected 5120, 5121"},
      {"/bufferViews/1/byteLength", 1000,
       "/bufferViews/1: bytes 8 to 1008, expected an end within the buffer's 44"},
      {"/bufferViews/1/byteOffset", 9007199254740991, "/bufferViews/1: bytes 9007199254740991 to"},
      {"/bufferViews/1/byteStride", 8, "/bufferViews/1/byteStride: 8, expected at least the 12 bytes"},
      {"/bufferViews/1/byteStride", 5,
       "/bufferViews/1/byteStride: 5, expected a multiple of 4 from 4 to 252"},
      {"/bufferViews/1/buffer", 1, "/bufferViews/1/buffer: 1, expected an index below 1"},
      {"/buffers/0/byteLength", 45,
       "/buffers/0/byteLength: 45, expected at most the 44 bytes that there are"},
      {"/buffers/0/uri", "data:;base64,A*", "/buffers/0/uri: character '*', expected base64"},
      {"/buffers/0/uri", "data:text/plain,abc",
       "/buffers/0/uri: 'data:text/plain', expected data:...;base64"},
      {"/buffers/0/uri", "gone.bin", "/buffers/0/uri: no such file"},
      {"/buffers/0/uri", nullptr, "/buffers/0: key \"uri\" is missing"},
      {"/extensionsRequired",
       {"KHR_draco_mesh_compression"},
       "/extensionsRequired/0: extension 'KHR_draco_mesh_compression' is not read"},
      {"/extensionsRequired",
       {"KHR_mesh_quantization", "EXT_meshopt_compression"},
       "/extensionsRequired/1: extension 'EXT_meshopt_compression'"},
      {"/accessors/1/sparse",
       {{"count", 4},
        {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
        {"values", {{"bufferView", 1}}}},
       "/accessors/1/sparse/count: 4, expected at most the accessor's 3"},
      {"/accessors/1/sparse",
       {{"count", 1},
        {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
        {"values", {{"bufferView", 0}}}},
       "/accessors/1/sparse/values/count: 1, expected at most 0"},
      {"/accessors/1/sparse",
       {{"count", 2},
        {"indices", {{"bufferView", 1}, {"componentType", 5125}, {"byteOffset", 12}}},
        {"values", {{"bufferView", 1}}}},
       "/accessors/1/sparse/indices: index 1065353216, expected one below 3"},
      {"/materials",
       {{{"alphaMode", "GLASS"}}},
       "/materials/0/alphaMode: \"GLASS\", expected \"OPAQUE\", \"MASK\""},
      {"/materials",
       {{{"emissiveFactor", {1, 2, 0}}}},
       "/materials/0/emissiveFactor/1: 2, expected a number from 0 to 1"},
      {"/materials",
       {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}},
       "baseColorTexture/index: 0, expected an index below 0, the number of textures"},
  };
  GltfText text = gltf_triangle();
  text.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, json::object()};
  text.embedded();
  for (const auto& [pointer, value, says] : faults) {
    json broken = text.json;
    const json::json_pointer place(pointer);
    if (value.is_null()) {
      broken[place.parent_pointer()].erase(place.back());
    } else {
      broken[place] = value;
    }
    const std::string message = gltf_error_of(broken.dump());
    EXPECT_TRUE(message.starts_with("t.gltf: ")) << pointer << ": " << message;
    EXPECT_NE(message.find(says), message.npos) << pointer << ": " << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
  }
}

TEST(Gltf, WhatIsNoGltf) {
  EXPECT_EQ(gltf_error_of("{\"asset\": {\n  \"version\" 2}}"),
            "t.gltf:2:13: no JSON: syntax error while parsing object separator - unexpected number literal; "
            "expected ':'");
  EXPECT_NE(gltf_error_of("{\"a\": 1, \"a\": 2}").find("/a: given twice"), std::string::npos);
  EXPECT_NE(gltf_error_of("[]").find("t.gltf: [], expected an object"), std::string::npos)
      << gltf_error_of("[]");
  EXPECT_NE(gltf_error_of(std::string(100000, '[')).find("nested too deep"), std::string::npos);
  EXPECT_NE(gltf_error_of("{\"asset\": {\"version\": 1e999}}").find("no JSON"), std::string::npos);
  const std::string binary = gltf_triangle().binary();
  EXPECT_EQ(read_gltf(binary).positions, TRIANGLE_CORNERS);
  for (std::size_t size = 4; size < binary.size(); ++size) {
    const std::string message = gltf_error_of(binary.substr(0, size));
    EXPECT_TRUE(message.starts_with("t.gltf: ")) << size << message;
  }
  std::string other = binary;
  other[4] = 1;
  EXPECT_EQ(gltf_error_of(other), "t.gltf: GLB version 1, expected 2");
}

}  // namespace
}  // namespace coppice
