// Textures: what materials say of them, decoded images, mip levels, and what is missing.
#include <gtest/gtest.h>

#include <cmath>

#include "render/texture_arrays.h"
#include "scene/material_maps.h"
#include "scene/texture.h"
#include "scene/write_png.h"
#include "support/gltf_text.h"
#include "support/obj_folder.h"
#include "support/read_gltf.h"

namespace coppice {
namespace {

using TextureFiles = ObjFolder;

std::vector<Material> mtl_materials(const std::string& mtl, std::vector<std::string>* warnings = nullptr) {
  const auto find = [&](const std::string&, MtlMatch) { return FoundMtl{"tex/m.mtl", "newmtl a\n" + mtl}; };
  const Scene scene = parse_obj("mtllib m.mtl\n" + TRIANGLE + "f 1 2 3\n", "m.obj", find);
  if (warnings) *warnings = scene.warnings;
  return scene.materials;
}

std::string to_bytes(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

// An uncompressed TGA of 32 bits, from the top down; texels as 0xAARRGGBB.
std::string tga(int width, int height, const std::vector<std::uint32_t>& argb) {
  std::string bytes = to_bytes(
      {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, width & 255, width >> 8, height & 255, height >> 8, 32, 0x28});
  for (const std::uint32_t texel : argb) bytes += little_endian(texel);
  return bytes;
}

TEST(MtlMaps, OptionsBeforeTheName) {
  const Material material = mtl_materials(
      "map_Kd -o 0.25 0.5 -s 2 4 1 -clamp on my tex.png\nMAP_KE -blendu off -boost 2 e.png\n"
      "bump -bm 0.5 -imfchan r b.png\nnorm n.png\nmap_d -imfchan m d.png\nmap_Pr \"r s.png\"\nmap_Pm -s 2 "
      "m.png\n"
      "Pr 0.25\nPm 7\n")[1];
  const TextureMap& diffuse = material.diffuse_map;
  EXPECT_EQ(diffuse.name, "my tex.png");
  EXPECT_EQ(diffuse.folder, "tex");
  EXPECT_EQ(diffuse.scale, glm::vec2(2, -4));
  EXPECT_EQ(diffuse.offset, glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(diffuse.wrap_u, TextureWrap::clamp);
  EXPECT_EQ(material.emission_map.name, "e.png");
  EXPECT_EQ(material.emission_map.wrap_v, TextureWrap::repeat);
  EXPECT_EQ(material.bump_map.name, "b.png");
  EXPECT_EQ(material.bump_map.strength, 0.5f);
  EXPECT_EQ(material.bump_map.channel, 'r');
  EXPECT_EQ(material.normal_map.name, "n.png");
  EXPECT_EQ(material.opacity_map.channel, 'm');
  EXPECT_EQ(material.roughness_map.name, "r s.png");
  EXPECT_EQ(material.metallic_map.name, "m.png");
  EXPECT_EQ(material.metallic_map.scale, glm::vec2(2, -1));
  EXPECT_EQ(material.roughness, 0.25f);
  EXPECT_EQ(material.metallic, 1.0f);
}

TEST(MtlMaps, WhatIsNoOptionBeginsTheName) {
  for (const auto& [text, name] : {std::pair{"-s 1 2 3 4.png", "4.png"},
                                   {"-o 1 1.png", "1.png"},
                                   {"-x.png", "-x.png"},
                                   {"-bm b.png", "-bm b.png"},
                                   {"tex\\a.png", "tex\\a.png"},
                                   {"-clamp off", ""},
                                   {"-s 1 1 1", ""}}) {
    EXPECT_EQ(mtl_materials("map_Kd " + std::string(text) + "\n")[1].diffuse_map.name, name) << text;
  }
  std::vector<std::string> warnings;
  EXPECT_EQ(mtl_materials("map_Kd -mm 0 2 a.png\n", &warnings)[1].diffuse_map.name, "a.png");
  EXPECT_EQ(
      warnings,
      (std::vector<std::string>{"tex/m.mtl:2: map_Kd of material 'a' has -mm or -t, which are not used"}));
}

GltfText textured_gltf() {
  GltfText text = gltf_triangle();
  text.json["meshes"][0]["primitives"][0]["material"] = 0;
  text.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  text.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
  const std::string image = tga(1, 1, {0xff804020});
  const int view = text.view(std::vector<char>(image.begin(), image.end()));
  text.json["images"] = {{{"uri", "a%20b.png"}}, {{"bufferView", view}, {"mimeType", "image/x-tga"}}};
  text.json["materials"] = {
      {{"alphaMode", "MASK"},
       {"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}},
         {"baseColorFactor", {1, 1, 1, 0.8}},
         {"roughnessFactor", 0.5},
         {"metallicRoughnessTexture", {{"index", 1}}}}},
       {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
       {"emissiveTexture",
        {{"index", 1},
         {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}}}}}}}}};
  return text;
}

TEST(GltfMaps, TexturesAndSamplers) {
  const Material material = read_gltf(textured_gltf().embedded()).materials[1];
  EXPECT_EQ(material.diffuse_map.name, "a b.png");
  EXPECT_EQ(material.diffuse_map.wrap_u, TextureWrap::clamp);
  EXPECT_EQ(material.diffuse_map.wrap_v, TextureWrap::mirror);
  EXPECT_EQ(material.diffuse_map.scale, glm::vec2(1));
  EXPECT_EQ(material.opacity_map.channel, 'm');
  EXPECT_EQ(material.alpha_cutoff, 0.5f / 0.8f);
  EXPECT_EQ(material.roughness_map.channel, 'g');
  EXPECT_EQ(material.metallic_map.channel, 'b');
  EXPECT_EQ(material.roughness, 0.5f);
  EXPECT_EQ(material.metallic, 1.0f);
  EXPECT_EQ(material.normal_map.strength, 0.5f);
  EXPECT_EQ(material.emission_map.scale, glm::vec2(2, 3));
  EXPECT_EQ(material.emission_map.offset, glm::vec2(0.25f, 0.5f));
  ASSERT_TRUE(material.normal_map.bytes);
  EXPECT_EQ(material.normal_map.bytes, material.emission_map.bytes);
  EXPECT_EQ(decode_texture(*material.normal_map.bytes, false).levels[0].texels[0], 0xff204080);
}

TEST(GltfMaps, ErrorsNameTheIndex) {
  GltfText text = textured_gltf();
  text.json["textures"][0]["sampler"] = 3;
  EXPECT_EQ(gltf_error_of(text.embedded()),
            "t.gltf: /textures/0/sampler: 3, expected an index below 1, the number of samplers");
  text = textured_gltf();
  text.json["images"][1]["bufferView"] = 9;
  EXPECT_EQ(gltf_error_of(text.embedded()),
            "t.gltf: /images/1/bufferView: 9, expected an index below 3, the number of buffer views");
  text = textured_gltf();
  text.json["materials"][0]["normalTexture"]["texCoord"] = 1;
  const Scene scene = read_gltf(text.embedded());
  EXPECT_FALSE(scene.materials[1].normal_map);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(TextureDecoding, KindsOfFiles) {
  const Texture texture = decode_texture(tga(2, 1, {0x80ff4001, 0xff000000}), true);
  EXPECT_EQ(texture.levels[0].texels, (std::vector<std::uint32_t>{0x800140ff, 0xff000000}));
  EXPECT_TRUE(texture.has_alpha && texture.is_colour);
  // 24 bits, from the bottom up, a row of one texel filled to four bytes.
  const std::string bmp = to_bytes({'B', 'M', 62, 0, 0, 0, 0, 0,  0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0,
                                    0,   2,   0,  0, 0, 1, 0, 24, 0, 0, 0,  0, 0, 8, 0,  0, 0, 0, 0, 0, 0,
                                    0,   0,   0,  0, 0, 0, 0, 0,  0, 0, 0,  0, 1, 2, 3,  0, 4, 5, 6, 0});
  EXPECT_EQ(decode_texture(bmp, false).levels[0].texels,
            (std::vector<std::uint32_t>{0xff040506, 0xff010203}));
}

TEST(TextureDecoding, ErrorsSayWhatWasExpected) {
  const auto error_of = [](const std::string& bytes) {
    try {
      decode_texture(bytes, true);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_TRUE(error_of("").starts_with("no PNG, JPEG, TGA or BMP that can be read"));
  EXPECT_TRUE(error_of("GIF89a").starts_with("no PNG, JPEG, TGA or BMP that can be read"));
  EXPECT_EQ(error_of(tga(16385, 1, {})), "16385 by 1 texels, expected from 1 to 16384 a side");
}

Texture made(std::uint32_t width, std::uint32_t height, bool is_colour, auto texel) {
  Texture texture;
  texture.is_colour = is_colour;
  texture.levels.push_back({width, height, {}});
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) texture.levels[0].texels.push_back(texel(x, y));
  make_mip_levels(texture);
  return texture;
}

TEST(MipLevels, SidesAreHalvedDownToOne) {
  const Texture texture = made(13, 4, true, [](auto, auto) { return 0x7f3c8001u; });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (const Texture::Level& level : texture.levels) {
    sides.emplace_back(level.width, level.height);
    for (const std::uint32_t texel : level.texels) EXPECT_EQ(texel, 0x7f3c8001u);  // what is even stays
  }
  EXPECT_EQ(sides, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{13, 4}, {6, 2}, {3, 1}, {1, 1}}));
}

TEST(MipLevels, ColoursAreAveragedInLinearLightNumbersAsTheyAre) {
  const auto checker = [](auto x, auto y) { return (x + y) % 2 ? 0xffffffffu : 0u; };
  EXPECT_EQ(made(2, 2, true, checker).levels[1].texels[0], 0x80bcbcbcu);  // 188 is half the light of 255
  EXPECT_EQ(made(2, 2, false, checker).levels[1].texels[0], 0x80808080u);
}

TEST(MipLevels, OddSidesWeighEachTexelByWhatIsCovered) {
  // 5 to 2: each covers two and a half.
  const Texture texture = made(5, 1, false, [](auto x, auto) { return std::uint32_t{x == 2 ? 250u : 0u}; });
  EXPECT_EQ(texture.levels[1].texels, (std::vector<std::uint32_t>{50, 50}));
  const Texture edge = made(5, 1, false, [](auto x, auto) { return std::uint32_t{x == 0 ? 250u : 0u}; });
  EXPECT_EQ(edge.levels[1].texels, (std::vector<std::uint32_t>{100, 0}));
  EXPECT_EQ(edge.levels[2].texels, (std::vector<std::uint32_t>{50}));
}

TEST_F(TextureFiles, AreFoundNearAndDecodedOnce) {
  std::filesystem::create_directories(folder_ / "Tex");
  const std::vector<std::uint32_t> texels = {0xff0000ff, 0xff00ff00};
  write_png(folder_ / "Tex" / "Red Wall.PNG", 2, 1, texels);
  write("m.mtl",
        "newmtl a\nmap_Kd tex\\red wall.png\nmap_Bump C:\\work\\Tex\\missing.png\nnewmtl b\n"
        "map_Kd tex\\red wall.png\nnewmtl unused\nmap_Kd no.png\n");
  write("broken.png", "\x89PNG\r\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  EXPECT_TRUE(scene.warnings.empty());
  const TextureArrays arrays = texture_arrays(scene);
  ASSERT_EQ(arrays.headers.size(), 2u);
  EXPECT_EQ(arrays.materials[1].diffuse, arrays.materials[2].diffuse);
  EXPECT_EQ(arrays.materials[3].diffuse, TEXTURE_NONE);
  const TextureHeader& header = arrays.headers[arrays.materials[1].diffuse];
  EXPECT_EQ(header.width, 2u);
  EXPECT_EQ(header.levels, 2u);
  EXPECT_EQ(header.flags, TEXTURE_COLOUR);
  EXPECT_EQ(arrays.texels[header.first_word], texels[0]);
  const TextureHeader& checker = arrays.headers[arrays.materials[1].bump];
  EXPECT_EQ(checker.width, 8u);
  EXPECT_EQ(arrays.texels[checker.first_word], 0xffff00ffu);
  EXPECT_EQ(arrays.texels[checker.first_word + 1], 0xff000000u);
  ASSERT_EQ(arrays.warnings.size(), 1u);
  EXPECT_EQ(arrays.warnings[0].substr((folder_ / "").string().size()),
            "C:\\work\\Tex\\missing.png: no such file, a checker takes its place as map_Bump of "
            "material 'a'");
}

TEST_F(TextureFiles, BrokenOnesAreCheckers) {
  write("broken.png", "\x89PNG\r\n");
  write("m.mtl", "newmtl a\nmap_Ke broken.png\n");
  const TextureArrays arrays = texture_arrays(load("mtllib m.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n"));
  ASSERT_EQ(arrays.warnings.size(), 1u);
  const std::string warning = arrays.warnings[0].substr((folder_ / "").string().size());
  EXPECT_TRUE(warning.starts_with("broken.png: no PNG, JPEG, TGA or BMP that can be read (")) << warning;
  EXPECT_TRUE(warning.ends_with("), a checker takes its place as map_Ke of material 'a'")) << warning;
  EXPECT_EQ(arrays.headers.at(0).width, 8u);
}

TEST(TextureArraysOfScenes, ThoseWithoutMapsHaveNone) {
  const TextureArrays arrays = texture_arrays(Scene{});
  EXPECT_TRUE(arrays.empty() && arrays.texels.empty() && arrays.srgb_to_linear.empty());
}

TEST(TextureArraysOfScenes, CornersHaveAllThreeOrNone) {
  Scene scene = parse_obj(
      TRIANGLE + "vt 0.5 1e-39\nvt 1 1\nvn 0 3 4\nvn 0 0 0\nf 1/1/1 2/2/1 3/2/1\nf 1/1/1 2//2 3/1/1\n",
      "a.obj", [](const std::string&, MtlMatch) { return std::nullopt; });
  const std::vector<CornerAttributes> corners = corner_attributes(scene);
  ASSERT_EQ(corners.size(), 2u);
  EXPECT_EQ(corners[0].flags, HAS_TEXCOORDS | HAS_NORMALS);
  EXPECT_EQ(corners[0].texcoord_a, vec2(0.5f, 0));
  EXPECT_EQ(corners[0].normal_b, vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(corners[1].flags, 0u);
  EXPECT_EQ(corners[1].texcoord_c, vec2(0));
}

}  // namespace
}  // namespace coppice
