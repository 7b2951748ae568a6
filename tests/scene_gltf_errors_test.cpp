// glTF files: every error names its place.
#include <gtest/gtest.h>

#include "support/gltf_text.h"
#include "support/read_gltf.h"

namespace coppice {
namespace {

using nlohmann::json;

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
  EXPECT_EQ(read_gltf(binary).positions.size(), 3u);
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
