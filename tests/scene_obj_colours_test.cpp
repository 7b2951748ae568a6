// What of an MTL file becomes the colour of a surface.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/obj_folder.h"

namespace coppice {
namespace {

using ObjColours = ObjFolder;

TEST_F(ObjColours, ReadsMaterials) {
  write("a.mtl",
        "newmtl red\r\nKa 0.1 0.2 0.3\r\nKd 1 0 0\r\nKs 0.5 0.5 0.5\r\nKe 2 3 4\r\nNs 20\r\nNi 1.5\r\nd "
        "0.25\r\n"
        "illum 7\r\nmap_Kd -s 1 1 1 tex/red.png\r\n");
  write("b.mtl", "newmtl dim\nKd 0.5 0.25 0.125\nTf 0.5 1 0.25\nTr 0.25\n");
  const Scene scene =
      load("mtllib a.mtl b.mtl\n" + TRIANGLE + "f 1 2 3\nusemtl dim  \nf 1 2 3\nusemtl red\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0, 2, 1}));
  const Material& red = scene.materials[1];
  EXPECT_EQ(red.name, "red");
  EXPECT_EQ(red.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(red.specular, glm::vec3(0.5f));
  EXPECT_EQ(red.emission, glm::vec3(2, 3, 4));
  EXPECT_EQ(red.shininess, 20.0f);
  EXPECT_EQ(red.filter, glm::vec3(1));
  EXPECT_EQ(scene.materials[2].filter, glm::vec3(0.5f, 1, 0.25f));
  EXPECT_EQ(red.index_of_refraction, 1.5f);
  EXPECT_EQ(red.opacity, 0.25f);
  EXPECT_EQ(red.illum, 7);
  EXPECT_EQ(red.diffuse_map.name, "tex/red.png");
  EXPECT_EQ(scene.materials[2].opacity, 0.75f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjColours, NumbersInMaterialsThatFloatCannotHoldStayFinite) {
  write("a.mtl", "newmtl a\nKd 1e99 -1e99 0.5\nNs 1e99\nd 7\nNi -1e99\n");
  const Scene scene = load("mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3");
  const Material& material = scene.materials.at(1);
  EXPECT_EQ(material.diffuse, glm::vec3(0, 0, 0.5f));
  EXPECT_TRUE(std::isfinite(material.shininess));
  EXPECT_TRUE(std::isfinite(material.index_of_refraction));
  EXPECT_EQ(material.opacity, 1.0f);
}

TEST_F(ObjColours, CutsExponentsOfManyDigitsButNotNames) {
  write("m.mtl", "newmtl 1e1234567890\nKd 1e-1234567890 2e+00000000001 .5\nNs 1e1234567890\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl 1e1234567890\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].diffuse, glm::vec3(0, 20, 0.5f));
  EXPECT_EQ(scene.materials[1].shininess, 1);  // infinite, which is none
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{1}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjColours, CutsExponentsOfManyDigitsWhateverStandsAboutThem) {
  write("m.mtl",
        "newmtl a 1e1234567890\nKd 1e-12345678900.5e9876543210 2 3\nKs newmtl 1e-1234567890 4\nNs 5\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl a 1e1234567890\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].name, "a 1e1234567890");
  EXPECT_EQ(scene.materials[1].diffuse, Material{}.diffuse);
  EXPECT_EQ(scene.materials[1].specular, glm::vec3(0));  // begins with no number: no colour
  EXPECT_EQ(scene.materials[1].shininess, 5);
  EXPECT_EQ(scene.warnings.size(), 1u);  // of the Kd
}

// The materials of an MTL text, without the default one.
std::vector<Material> materials_in(const std::string& mtl) {
  const auto find_mtl = [&](const std::string&, MtlMatch) { return FoundMtl{"m.mtl", mtl}; };
  std::vector<Material> materials = parse_obj("mtllib m.mtl\n" + TRIANGLE, "m.obj", find_mtl).materials;
  materials.erase(materials.begin());
  return materials;
}

TEST(ObjMaterialColours, OneNumberStandsForAllThree) {
  for (const std::string colour :
       {"Kd 0.5", "Kd 0.5 # grey", "Kd\t0.5 ", "kd 0.5", "Kd 5e-1\\\n", "Kd \\\r\n0.5 \\\n 0.5 0.5"}) {
    const std::vector<Material> read = materials_in("newmtl a\n" + colour + "\nKs 0.25\nKe 2 # lamp\n");
    ASSERT_EQ(read.size(), 1u) << colour;
    EXPECT_EQ(read[0].diffuse, glm::vec3(0.5f)) << colour;
    EXPECT_EQ(read[0].specular, glm::vec3(0.25f)) << colour;
    EXPECT_EQ(read[0].emission, glm::vec3(2)) << colour;
  }
}

TEST(ObjMaterialColours, ContinuedLinesAreOneLineAndCommentsContinueNothing) {
  const std::vector<Material> read = materials_in(
      "# from C:\\tex\\\nnewmtl a # \\\nKd 0.1 \\\n 0.2 \\ \r\n 0.3 # in C:\\tex\\\nNs 7\n\t# \\\nillum "
      "2\nKs 1 0 0\\");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].diffuse, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(read[0].shininess, 7);
  EXPECT_EQ(read[0].illum, 2);
  EXPECT_EQ(read[0].specular, glm::vec3(1, 0, 0));
}

TEST(ObjMaterialColours, AMaterialWithoutKdLooksTheSameWhereverItStands) {
  const std::vector<std::string> without = {"newmtl b\nmap_Kd wood.png\n", "newmtl b\nKa 1 1 1\n",
                                            "newmtl b\nNs 5\nmap_Kd wood.png\nKa 0 0 0\n", "newmtl b\n"};
  const std::string before = "newmtl a\nKd 0.1 0.2 0.3\nmap_Kd wood.png\n",
                    after = "newmtl c\nmap_Kd x.png\nKd 0 0 0\n";
  for (const std::string& text : without) {
    EXPECT_EQ(materials_in(text)[0].diffuse, Material{}.diffuse) << text;
    EXPECT_EQ(materials_in(before + text + after)[1].diffuse, Material{}.diffuse) << text;
    EXPECT_EQ(materials_in(after + text + before)[1].diffuse, Material{}.diffuse) << text;
  }
  EXPECT_EQ(materials_in(before + after)[0].diffuse, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(materials_in(before + after)[1].diffuse, glm::vec3(0));
}

TEST(ObjMaterialColours, KaIsNoPaint) {
  for (const std::string ka : {"Ka 1 1 1", "Ka 0.588 0.588 0.588", "Ka 0 0 0", "Ka 0.2", ""}) {
    for (const std::string& order : {ka + "\nKd 0.8 0.05 0.05\n", "Kd 0.8 0.05 0.05\n" + ka + "\n"}) {
      EXPECT_EQ(materials_in("newmtl a\n" + order)[0], materials_in("newmtl a\nKd 0.8 0.05 0.05\n")[0]) << ka;
    }
  }
}

TEST(ObjMaterialColours, OpacityIsRightHoweverItIsWritten) {
  for (const std::string opacity :
       {"d 0.5", "d -halo 0.5", "Tr 0.5", "d 0.5\nTr 0.9", "Tr 0.9\nd -halo 0.5", "d 0.5 # half"}) {
    EXPECT_EQ(materials_in("newmtl a\n" + opacity + "\n")[0].opacity, 0.5f) << opacity;
  }
  EXPECT_EQ(materials_in("newmtl a\nd\nTr\nKd 1 1 1\n")[0].opacity, 1);
}

TEST(ObjMaterialColours, CoordinatesOfCieXyzAreConverted) {
  const glm::vec3 white = materials_in("newmtl a\nKd xyz 0.9505 1 1.089\n")[0].diffuse;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(white[axis], 1, 1e-3);
}

TEST_F(ObjColours, AColourThatIsNotGivenInNumbersIsSaidOnce) {
  write("m.mtl", "newmtl a\nNs 1\nKd spectral wood.rfl 1\nnewmtl b\nKd spectral oak.rfl\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n");
  EXPECT_EQ(scene.materials[1].diffuse, Material{}.diffuse);
  EXPECT_EQ(
      warnings_of(scene),
      std::vector<std::string>{
          "m.mtl:3: Kd of material 'a' is not given in one or three numbers and not read; 2 such in all"});
}

TEST_F(ObjColours, EveryNumberOfAColourIsLookedAt) {
  for (const std::string colour :
       {"0,8 0,2 0,1", "0.8 x 0.1", "0.8 0.2 nan", "1.#IND 0 0", "0x1p-1 0 0", "0.8 0.4"}) {
    write("m.mtl", "newmtl a\nKd " + colour + "\n");
    const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n");
    EXPECT_EQ(scene.materials[1].diffuse, Material{}.diffuse) << colour;
    EXPECT_EQ(warnings_of(scene),
              std::vector<std::string>{
                  "m.mtl:2: Kd of material 'a' is not given in one or three numbers and not read"})
        << colour;
  }
}

TEST_F(ObjColours, ColoursOfVerticesAreSaidOnce) {
  const Scene scene = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0 1\nv 0 1 0 0.5 # 1 1 1\nv 0 0 1 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(warnings_of(scene),
            std::vector<std::string>{"scene.obj:1: colours of vertices are not used; 3 such in all"});
}

}  // namespace
}  // namespace coppice
