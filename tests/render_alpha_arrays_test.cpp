// What materials say of opacity, as the traces take it.
#include "render/alpha_arrays.h"
#include "render/texture_arrays.h"
#include "scene/texture.h"
#include "support/gltf_text.h"
#include "support/masked_scene.h"
#include "support/obj_folder.h"
#include "support/read_gltf.h"

namespace coppice {
namespace {

AlphaArrays arrays_of(const Scene& scene) { return alpha_arrays(scene, corner_attributes(scene)); }

// The codes of a map, which are bytes.
std::vector<uint> codes_of(const AlphaArrays& arrays, const AlphaMap& map) {
  std::vector<uint> codes;
  for (uint i = map.first_texel; i < map.first_texel + map.width * map.height; ++i)
    codes.push_back(arrays.texels.at(i / 4) >> (i % 4 * 8) & 255);
  return codes;
}

TEST(AlphaArraysOfScenes, HaveTheCodesAndThePlaceOfTheMap) {
  Scene scene = masked_square(opacity_of(3, 2, {1, 2, 3, 4, 5, 255}), 0.25f);
  scene.materials[0].opacity_map.wrap_u = TextureWrap::mirror;
  scene.materials[0].opacity_map.offset = {0.5f, 1e-30f};
  const AlphaArrays arrays = arrays_of(scene);
  ASSERT_EQ(arrays.maps.size(), 1u);
  const AlphaMap& map = arrays.maps[0];
  EXPECT_EQ(codes_of(arrays, map), (std::vector<uint>{1, 2, 3, 4, 5, 255}));
  EXPECT_EQ(map.flags, TEXTURE_MIRROR | TEXTURE_CLAMP << TEXTURE_WRAP_V_SHIFT);
  EXPECT_EQ(map.scale, vec2(1, -1));
  EXPECT_EQ(map.offset, vec2(0.5f, 0));
  EXPECT_EQ(map.threshold, 63.75f);
  EXPECT_EQ(map.is_coverage, 0u);
  ASSERT_EQ(arrays.triangles.size(), 2u);
  EXPECT_EQ(arrays.triangles[1].map, 0u);
  EXPECT_EQ(arrays.triangles[1].texcoord_b, vec2(1, 1));
  EXPECT_EQ(arrays.texels.size(), 2u);
}

TEST(AlphaArraysOfScenes, WhatNeedsNoMapHasNone) {
  const auto map_word = [](const TextureMap& map, std::optional<float> cutoff, float opacity = 1) {
    Scene scene = masked_square(map, cutoff);
    scene.materials[0].opacity = opacity;
    const AlphaArrays arrays = arrays_of(scene);
    EXPECT_EQ(arrays.empty(), arrays.maps.empty());
    return arrays.empty() ? ALPHA_SOLID : arrays.triangles[0].map;
  };
  const TextureMap all = opacity_of(1, 2, {255, 255}), none = opacity_of(1, 1, {0});
  const TextureMap grey = opacity_of(2, 1, {100, 150});
  EXPECT_EQ(map_word({}, {}), ALPHA_SOLID);
  EXPECT_EQ(map_word(all, {}), ALPHA_SOLID);
  EXPECT_EQ(map_word(all, 1.0f), ALPHA_SOLID);
  EXPECT_EQ(map_word(all, 1.01f), ALPHA_NOTHING);
  EXPECT_EQ(map_word(grey, 0.39f), ALPHA_SOLID);
  EXPECT_EQ(map_word(grey, 0.4f), 0u);
  EXPECT_EQ(map_word(grey, 0.6f), ALPHA_NOTHING);
  EXPECT_EQ(map_word(grey, 0.0f), ALPHA_SOLID);
  EXPECT_EQ(map_word(grey, {}), 0u);
  EXPECT_EQ(map_word(none, {}), ALPHA_NOTHING);
  EXPECT_EQ(map_word(all, {}, 0), ALPHA_NOTHING);
  EXPECT_EQ(map_word(all, {}, 0.5f), 1u);  // behind that of triangles without texture coordinates
  EXPECT_EQ(map_word({}, {}, 0.5f), 0u);
}

TEST(AlphaArraysOfScenes, CoverageIsTheMapTimesTheMaterials) {
  Scene scene = masked_square(opacity_of(2, 1, {0, 255}), {});
  scene.materials[0].opacity = 0.25f;
  AlphaArrays arrays = arrays_of(scene);
  EXPECT_EQ(arrays.maps[arrays.triangles[0].map].threshold, 1020);
  EXPECT_EQ(arrays.maps[arrays.triangles[0].map].is_coverage, 1u);
  scene.materials[0].illum = 7;  // of glass the map alone
  arrays = arrays_of(scene);
  EXPECT_EQ(arrays.maps[arrays.triangles[0].map].threshold, 255);
  scene.texcoord_index.clear();  // as without a map
  scene.materials[0].illum = 1;
  arrays = arrays_of(scene);
  EXPECT_EQ(codes_of(arrays, arrays.maps[arrays.triangles[0].map]), std::vector<uint>{255});
}

class AlphaFiles : public ObjFolder {
 protected:
  Scene with_material(const std::string& statements) const {
    write("m.mtl", "newmtl a\n" + statements);
    return load("mtllib m.mtl\n" + TRIANGLE + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
  }
  // Of two texels, 0xaabbggrr, with these statements.
  std::vector<uint> codes(const std::string& statements, std::uint32_t first, std::uint32_t second) const {
    std::string bytes = tga_of(2, 1, {0, 0});
    bytes[16] = 32;
    bytes[17] = 0x28;
    bytes.resize(18);
    for (const std::uint32_t texel : {first, second})
      for (const int shift : {16, 8, 0, 24}) bytes += static_cast<char>(texel >> shift & 255);
    write("image.tga", bytes);
    const AlphaArrays arrays = arrays_of(with_material(statements));
    EXPECT_TRUE(arrays.warnings.empty());
    return codes_of(arrays, arrays.maps.at(arrays.triangles.at(0).map));
  }
};

TEST_F(AlphaFiles, OpacityIsAlphaWhereThereIsSomeElseLuminance) {
  using Codes = std::vector<uint>;
  EXPECT_EQ(codes("map_d image.tga\n", 0x80ffffff, 0xff000000), (Codes{0x80, 0xff}));
  EXPECT_EQ(codes("map_d image.tga\n", 0xff777777, 0xff000000), (Codes{0x77, 0}));
  EXPECT_EQ(codes("map_d image.tga\n", 0xff0000ff, 0xff00ff00), (Codes{54, 182}));
  EXPECT_EQ(codes("map_d -imfchan g image.tga\n", 0x80113355, 0xff000000), (Codes{0x33, 0}));
  EXPECT_EQ(codes("map_d -imfchan m image.tga\nmap_Kd image.tga\n", 0x80113355, 0xff0000ff),
            (Codes{0x80, 0xff}));
}

TEST_F(AlphaFiles, AColourMapThatIsACutOutCutsOut) {
  // So many texels with each alpha.
  const auto cuts = [&](const std::string& statements, const std::vector<std::pair<int, int>>& counts) {
    std::string texels;
    for (const auto& [alpha, count] : counts) {
      for (int i = 0; i < count; ++i) texels += std::string("\x10\x20\x30") + static_cast<char>(alpha);
    }
    const auto side = static_cast<std::uint16_t>(texels.size() / 4);
    std::string bytes = tga_of(side, 1, {});
    bytes[16] = 32;
    bytes[17] = 0x28;
    write("leaf.tga", bytes + texels);
    Scene scene = with_material(statements);
    EXPECT_FALSE(scene.materials[1].opacity_map && scene.materials[1].opacity_map.channel == 'm');
    find_cut_outs(scene);
    const TextureMap& map = scene.materials[1].opacity_map;
    return map && map.channel == 'm' && map.name == "leaf.tga";
  };
  EXPECT_TRUE(cuts("map_Kd leaf.tga\n", {{0, 1}, {255, 1}}));
  EXPECT_TRUE(cuts("map_Kd leaf.tga\n", {{15, 1}, {240, 99}}));
  EXPECT_TRUE(cuts("map_Kd leaf.tga\n", {{0, 50}, {255, 25}, {128, 25}}));
  EXPECT_FALSE(cuts("map_Kd leaf.tga\n", {{0, 50}, {255, 24}, {128, 26}})) << "soft";
  EXPECT_FALSE(cuts("map_Kd leaf.tga\n", {{255, 100}}));
  EXPECT_FALSE(cuts("map_Kd leaf.tga\n", {{0, 100}})) << "nothing would be left";
  EXPECT_FALSE(cuts("map_Kd leaf.tga\n", {{0, 1}, {255, 199}}));
  EXPECT_FALSE(cuts("map_Ke leaf.tga\n", {{0, 1}, {255, 1}}));
  EXPECT_FALSE(cuts("map_Kd leaf.tga\nmap_d other.png\n", {{0, 1}, {255, 1}}));
  EXPECT_FALSE(cuts("map_Kd gone.tga\n", {{0, 1}, {255, 1}}));
  write("plain.tga", tga_of(2, 1, {0, 0xffffff}));
  EXPECT_FALSE(cuts("map_Kd plain.tga\n", {{0, 1}, {255, 1}}));
}

TEST_F(AlphaFiles, AMissingOneIsAChecker) {
  const AlphaArrays arrays = arrays_of(with_material("map_d gone.png\n"));
  ASSERT_EQ(arrays.warnings.size(), 1u);
  EXPECT_EQ(arrays.warnings[0].substr((folder_ / "").string().size()),
            "gone.png: no such file, a checker takes its place as map_d of material 'a'");
  const AlphaMap& map = arrays.maps.at(arrays.triangles.at(0).map);
  EXPECT_EQ(map.width, 8u);
  EXPECT_EQ(codes_of(arrays, map)[0], 255u);
  EXPECT_EQ(codes_of(arrays, map)[1], 0u);
}

TEST_F(AlphaFiles, OpacityOutOfRangeIsBroughtIntoIt) {
  EXPECT_EQ(arrays_of(with_material("d -3\n")).triangles.at(0).map, ALPHA_NOTHING);
  EXPECT_TRUE(arrays_of(with_material("d 7\n")).empty());
  EXPECT_TRUE(arrays_of(with_material("d nan\n")).empty());
  EXPECT_TRUE(arrays_of(with_material("d 1e99\n")).empty());
  const AlphaArrays half = arrays_of(with_material("Tr 0.75\n"));
  EXPECT_EQ(half.maps.at(half.triangles.at(0).map).threshold, 1020);
}

// Of an opaque one alpha means nothing.
TEST(GltfAlpha, OpaqueImagesAreNoCutOuts) {
  GltfText text = gltf_triangle();
  text.json["meshes"][0]["primitives"][0]["material"] = 0;
  text.json["textures"] = {{{"source", 0}}};
  text.json["images"] = {{{"uri", "leaf.png"}}};
  text.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  Scene scene = read_gltf(text.embedded());
  EXPECT_TRUE(scene.materials[1].diffuse_map);
  EXPECT_FALSE(scene.materials[1].diffuse_map.may_cut_out);
}

TEST(GltfAlpha, ModesMeanWhatTheySay) {
  const auto arrays_with = [](const nlohmann::json& material) {
    GltfText text = gltf_triangle();
    text.json["meshes"][0]["primitives"][0]["material"] = 0;
    text.json["materials"] = nlohmann::json::array({material});
    return arrays_of(read_gltf(text.embedded()));
  };
  const auto of_factor = [](float alpha) -> nlohmann::json {
    return {{"baseColorFactor", {1, 1, 1, alpha}}};
  };
  nlohmann::json material = {{"pbrMetallicRoughness", of_factor(0.4f)}};
  EXPECT_TRUE(arrays_with(material).empty()) << "opaque by default";
  material["alphaMode"] = "MASK";
  EXPECT_EQ(arrays_with(material).triangles.at(0).map, ALPHA_NOTHING);
  material["alphaCutoff"] = 0.4f;
  EXPECT_TRUE(arrays_with(material).empty());
  material["alphaMode"] = "BLEND";
  const AlphaArrays blend = arrays_with(material);
  EXPECT_EQ(blend.maps.at(blend.triangles.at(0).map).threshold, 255 / 0.4f);
  EXPECT_EQ(blend.maps.at(0).is_coverage, 1u);
}

}  // namespace
}  // namespace coppice
