#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/obj_folder.h"

namespace coppice {
namespace {

using LoadObj = ObjFolder;

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
  EXPECT_EQ(warnings_of(scene)[0],
            "scene.obj:4: vertex with a coordinate that is no finite number; 5 such in all");
}

TEST_F(LoadObj, ANumberSignBehindAPointBeginsNoComment) {
  const Scene scene =
      load(TRIANGLE + "v -1.#IND00 0 0\nv 1.#QNAN 0 0\nv 0 0 1#comment\nf 1 2 4\nf 1 2 5\nf 1 2 3\n");
  EXPECT_EQ(count_inactive(scene), 2u);
  EXPECT_EQ(warnings_of(scene),
            std::vector<std::string>{
                "scene.obj:4: vertex with a coordinate that is no finite number; 2 such in all"});
}

TEST_F(LoadObj, StatementsMayBeCapitals) {
  const Scene scene = load("V 0 0 0\nv 1 0 0\nV 0 1 0\nF 1 2 3\n");
  EXPECT_EQ(scene.indices.size(), 1u);
  EXPECT_TRUE(scene.warnings.empty());
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

TEST_F(LoadObj, AVertexWithFewerThanThreeCoordinatesNamesItsLine) {
  EXPECT_EQ(error_in("v 1 2 3\nv 1 2\n"), "bad.obj:2: vertex with 2 coordinates, 3 are needed");
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

}  // namespace
}  // namespace coppice
