#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/input_error.h"
#include "scene/load_obj.h"

namespace coppice {
namespace {

const std::string TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// Every test writes its files into a folder of its own.
class LoadObj : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("coppice_load_obj_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene load(const std::string& text) const { return load_obj(write("scene.obj", text)); }

  // The message of the error, from the file's name on; empty if there is no error.
  std::string error_of(const std::filesystem::path& path) const {
    try {
      load_obj(path);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << "more than one line";
      EXPECT_TRUE(what.starts_with(path.string())) << "does not name the file: " << what;
      return path.filename().string() + what.substr(path.string().size());
    }
    return "";
  }
  std::string error_in(const std::string& text) const { return error_of(write("bad.obj", text)); }

  std::filesystem::path folder_;
};

TEST_F(LoadObj, ReadsATriangle) {
  const Scene scene = load(TRIANGLE + "f 1 2 3\n");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadObj, RoundsDecimalsToTheNearestFloat) {
  const Scene scene =
      load("v 0.1 16777217.000001 1.17549435e-38\nv +3.4028234663852886e38 -.5 5.\nv 1 2 3\nf 1 2 3");
  EXPECT_EQ(scene.positions[0], glm::vec3(0.1f, 16777218.0f, 1.17549435e-38f));
  EXPECT_EQ(scene.positions[1], glm::vec3(3.4028234663852886e38f, -0.5f, 5.0f));
}

TEST_F(LoadObj, JoinsShapesInFileOrder) {
  const Scene scene = load("o a\n" + TRIANGLE + "g x y\nf 1 2 3\no b\nv 5 5 5\ng\nf 2 3 4\ns off\nf 1 2 4");
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}, {1, 2, 3}, {0, 1, 3}}));
}

TEST_F(LoadObj, CountsNegativeIndicesBackFromTheFace) {
  const Scene scene = load(TRIANGLE + "f -3 -2 -1\nv 9 9 9\nf -2/-1/-1 -1//-1 1/1");
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}, {2, 3, 0}}));
}

TEST_F(LoadObj, AcceptsNormalsAndTextureCoordinatesThatAreMissing) {
  EXPECT_EQ(load(TRIANGLE + "f 1/7/8 2//9 3/1/\n").indices.size(), 1u);
}

TEST_F(LoadObj, AcceptsVerticesAfterTheFaceThatNamesThem) {
  EXPECT_EQ(load("f 1 2 3\n" + TRIANGLE).indices.size(), 1u);
}

TEST_F(LoadObj, ReadsEveryLineEnding) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const Scene scene = load("v 0 0 0" + end + "v 1 0 0" + end + end + "\t v 0 1 0" + end + "f 1 2 3 ");
    EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
  }
}

TEST_F(LoadObj, ReadsContinuedLinesCommentsAndAByteOrderMark) {
  const Scene scene =
      load("\xEF\xBB\xBFv 0 0 \\\r\n0\nv 1 0 0 # c\nv 0 1 0\n# C:\\folder\\\nf 1 2 \\\n 3 # 4\n");
  EXPECT_EQ(scene.positions.size(), 3u);
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
}

TEST_F(LoadObj, IgnoresLinesPointsAndUnknownStatements) {
  const Scene scene =
      load(TRIANGLE + "l 1 2 99\nl 0\np 0 77\nt sharp 99999999/0/0 1\nvw 0 -1 2\nfoo bar\nf 1 2 3\n");
  EXPECT_EQ(scene.indices.size(), 1u);
}

TEST_F(LoadObj, KeepsDegenerateTriangles) {
  EXPECT_EQ(load(TRIANGLE + "f 1 1 1\nf 1 2 1\n").indices.size(), 2u);
}

TEST_F(LoadObj, PolygonsThatCrossThemselvesAreCountedInAWarning) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_TRUE(load(square + "f 1 2 3 4\nf 1 2 2 3 4\nf 1 3 1 2 3 4\n").warnings.empty());
  const Scene scene = load(square + "f 1 3 2 4\nf 1 2 3 4\nf 1 2 4 3\n");
  EXPECT_EQ(scene.indices.size(), 6u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("edges that cross"), std::string::npos) << scene.warnings[0];
}

TEST_F(LoadObj, NoFacesGiveAnEmptySceneAndAWarning) {
  const Scene scene = load(TRIANGLE);
  EXPECT_TRUE(scene.indices.empty());
  EXPECT_FALSE(scene.materials.empty());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("no faces"), std::string::npos);
}

TEST_F(LoadObj, WhatIsNoFiniteNumberMakesTrianglesInactive) {
  const Scene scene =
      load(TRIANGLE + "v nan 0 0\nv 0 -inf 0\nv 0 0 1e39\nv 0 0 1,5\nv 0x1 0 0\nv 1e-60 0 0\n" +
           "f 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 8\nf 1 2 9\nf 1 2 3\n");
  EXPECT_EQ(count_inactive(scene), 5u);
  EXPECT_TRUE(std::isnan(scene.positions[3].x));
  EXPECT_EQ(scene.positions[5].z, INFINITY);
  EXPECT_EQ(scene.positions[8].x, 0.0f);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("5 vertices"), std::string::npos);
  EXPECT_NE(scene.warnings[0].find("line 4"), std::string::npos);
}

TEST_F(LoadObj, ReadsMaterials) {
  write("a.mtl",
        "newmtl red\r\nKa 0.1 0.2 0.3\r\nKd 1 0 0\r\nKs 0.5 0.5 0.5\r\nKe 2 3 4\r\nNs 20\r\nNi 1.5\r\nd "
        "0.25\r\n"
        "illum 7\r\nmap_Kd -s 1 1 1 tex/red.png\r\n");
  write("b.mtl", "newmtl dim\nKd 0.5 0.25 0.125\nTr 0.25\n");
  const Scene scene =
      load("mtllib a.mtl b.mtl\n" + TRIANGLE + "f 1 2 3\nusemtl dim  \nf 1 2 3\nusemtl red\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0, 2, 1}));
  const Material& red = scene.materials[1];
  EXPECT_EQ(red.name, "red");
  EXPECT_EQ(red.ambient, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(red.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(red.specular, glm::vec3(0.5f));
  EXPECT_EQ(red.emission, glm::vec3(2, 3, 4));
  EXPECT_EQ(red.shininess, 20.0f);
  EXPECT_EQ(red.index_of_refraction, 1.5f);
  EXPECT_EQ(red.opacity, 0.25f);
  EXPECT_EQ(red.illum, 7);
  EXPECT_EQ(red.diffuse_map, "tex/red.png");
  EXPECT_EQ(scene.materials[2].opacity, 0.75f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadObj, AmbientFallsBackToDiffuse) {
  write("a.mtl", "newmtl a\nKd 0.5 0.25 0.125\n");
  EXPECT_EQ(load("mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3").materials[1].ambient,
            glm::vec3(0.5f, 0.25f, 0.125f));
}

TEST_F(LoadObj, AMissingMaterialFileIsAWarningAndTheDefaultMaterial) {
  const Scene scene = load("mtllib none.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\nusemtl a\nf 1 2 3");
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0, 0}));
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_NE(scene.warnings[0].find("'none.mtl' not found"), std::string::npos);
  EXPECT_NE(scene.warnings[1].find("'a' not found"), std::string::npos);
}

TEST_F(LoadObj, ABrokenMaterialFileIsAWarningAndTheDefaultMaterial) {
  write("broken.mtl", std::string("\x00\xff\x01 junk\nKd\nillum\n", 18));
  std::filesystem::create_directory(folder_ / "folder.mtl");
  const Scene scene = load("mtllib broken.mtl folder.mtl\n" + TRIANGLE + "f 1 2 3");
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST_F(LoadObj, NumbersInMaterialsThatFloatCannotHoldStayFinite) {
  write("a.mtl", "newmtl a\nKd 1e99 nan 0.5\nNs 1e99\nd 7\nNi -1e99\n");
  const Scene scene = load("mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3");
  const Material& material = scene.materials.at(1);
  EXPECT_EQ(material.diffuse, glm::vec3(0, 0, 0.5f));
  EXPECT_TRUE(std::isfinite(material.shininess));
  EXPECT_TRUE(std::isfinite(material.index_of_refraction));
  EXPECT_EQ(material.opacity, 1.0f);
}

TEST_F(LoadObj, ManyMissingMaterialsGiveFewWarnings) {
  std::string text = TRIANGLE;
  for (int i = 0; i < 1000; ++i) text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  const Scene scene = load(text);
  EXPECT_EQ(scene.indices.size(), 1000u);
  EXPECT_LE(scene.warnings.size(), 21u);
}

TEST_F(LoadObj, AMissingFileIsAnError) {
  EXPECT_EQ(error_of(folder_ / "none.obj"), "none.obj: no such file");
}

TEST_F(LoadObj, AFolderIsAnError) {
  std::filesystem::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(error_of(folder_ / "folder.obj"), "folder.obj: is a directory, not an OBJ file");
}

TEST_F(LoadObj, AnEmptyFileIsAnError) { EXPECT_EQ(error_in(""), "bad.obj: empty file"); }

TEST_F(LoadObj, ABinaryFileIsAnError) {
  EXPECT_EQ(error_in(std::string("\x7f"
                                 "ELF\0\1\2\nv 0 0 0\n",
                                 17)),
            "bad.obj: a binary file, not an OBJ file");
}

TEST_F(LoadObj, AFileOfAnotherKindIsAnError) {
  const std::string expected = "bad.obj: not an OBJ file: no statement of the format in it";
  EXPECT_EQ(error_in("\xff\xd8\xff\xe0 JFIF\n"), expected);
  EXPECT_EQ(error_in("# a comment\n\n   \n"), expected);
  EXPECT_EQ(error_in("solid cube\nfacet normal 0 0 1\n"), expected);
}

TEST_F(LoadObj, AnIndexOutOfRangeNamesItsLine) {
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 3\nf 1 2 4\n"),
            "bad.obj:5: vertex index 4 is out of range: the file has 3 vertices");
  EXPECT_EQ(error_in(TRIANGLE + "f -4 1 2\n"),
            "bad.obj:4: vertex index -4 is out of range: there are 3 vertices before it");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 0\n"),
            "bad.obj:4: vertex index 0 is out of range: the first vertex is 1");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 99999999999\n"),
            "bad.obj:4: vertex index 99999999999 is out of range");
  EXPECT_EQ(error_in("f 1 2 3\n"), "bad.obj:1: vertex index 3 is out of range: the file has 0 vertices");
}

TEST_F(LoadObj, AnIndexThatIsNoNumberNamesItsLine) {
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 x\n"), "bad.obj:4: 'x' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 3.5\n"), "bad.obj:4: '3.5' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 /3\n"), "bad.obj:4: '/3' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1/2/3/4 2 3\n"), "bad.obj:4: '1/2/3/4' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1//2/3 2 3\n"), "bad.obj:4: '1//2/3' is no vertex index");
}

TEST_F(LoadObj, AFaceWithFewerThanThreeVerticesNamesItsLine) {
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2\n"), "bad.obj:4: face with 2 vertices, at least 3 are needed");
  EXPECT_EQ(error_in(TRIANGLE + "\r\nf 1\n"), "bad.obj:5: face with 1 vertex, at least 3 are needed");
  EXPECT_EQ(error_in(TRIANGLE + "f"), "bad.obj:4: face with 0 vertices, at least 3 are needed");
}

TEST_F(LoadObj, AVertexWithFewerThanThreeCoordinatesNamesItsLine) {
  EXPECT_EQ(error_in("v 1 2 3\nv 1 2\n"), "bad.obj:2: vertex with 2 coordinates, 3 are needed");
}

TEST_F(LoadObj, LineNumbersCountContinuedLines) {
  EXPECT_EQ(error_in("v 0 \\\n 0 \\\n 0\nf 1 \\\n 1\n"),
            "bad.obj:4: face with 2 vertices, at least 3 are needed");
}

TEST_F(LoadObj, MessagesShortenWhatTheyQuote) {
  EXPECT_LT(error_in(TRIANGLE + "f 1 2 " + std::string(100000, 'x')).size(), 200u);
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 \x1b[2J\n"), "bad.obj:4: '?[2J' is no vertex index");
}

TEST_F(LoadObj, SurvivesLinesOfAMillionCharacters) {
  const std::string filler(1000000, '7');
  EXPECT_EQ(count_inactive(load("v " + filler + " 0 0\nv 0." + filler + " 0 1\nv 0 1 0\nf 1 2 3\n")), 1u);
  EXPECT_EQ(load("# " + filler + "\no " + filler + "\nusemtl " + filler + "\n" + TRIANGLE + "f 1 2 3")
                .indices.size(),
            1u);
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 " + filler),
            "bad.obj:4: vertex index " + std::string(60, '7') + "... is out of range");
  EXPECT_EQ(error_in(filler), "bad.obj: not an OBJ file: no statement of the format in it");
}

TEST_F(LoadObj, SurvivesAFaceOfAMillionCharacters) {
  std::string face = "f";
  for (int i = 0; i < 170000; ++i) face += " 1 2 3";
  EXPECT_EQ(load(TRIANGLE + face).indices.size(), 510000u - 2);
}

TEST_F(LoadObj, CutsExponentsOfManyDigitsButNotNames) {
  write("m.mtl", "newmtl 1e1234567890\nKd 1e-1234567890 2e+00000000001 .5\nNs 1e1234567890\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl 1e1234567890\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].diffuse, glm::vec3(0, 20, 0.5f));
  EXPECT_EQ(scene.materials[1].shininess, 1);  // infinite, which is none
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{1}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadObj, CutsExponentsOfManyDigitsWhateverStandsAboutThem) {
  write("m.mtl",
        "newmtl a 1e1234567890\nKd 1e-12345678900.5e9876543210 2 3\nKs newmtl 1e-1234567890 4\nNs 5\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl a 1e1234567890\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].name, "a 1e1234567890");
  EXPECT_EQ(scene.materials[1].diffuse, glm::vec3(0, 2, 3));
  EXPECT_EQ(scene.materials[1].specular, glm::vec3(0, 0, 4));
  EXPECT_EQ(scene.materials[1].shininess, 5);
  EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace coppice
