// How names of materials and of MTL files are understood.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/obj_folder.h"

namespace coppice {
namespace {

using ObjNames = ObjFolder;

TEST_F(ObjNames, AMissingMaterialFileIsAWarningAndTheDefaultMaterial) {
  const Scene scene = load("mtllib none.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\nusemtl a\nf 1 2 3");
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0, 0}));
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_NE(scene.warnings[0].find("'none.mtl' not found"), std::string::npos);
  EXPECT_NE(scene.warnings[1].find("'a' not found"), std::string::npos);
}

TEST_F(ObjNames, ABrokenMaterialFileIsAWarningAndTheDefaultMaterial) {
  write("broken.mtl", std::string("\x00\xff\x01 junk\nKd\nillum\n", 18));
  std::filesystem::create_directory(folder_ / "folder.mtl");
  const Scene scene = load("mtllib broken.mtl folder.mtl\n" + TRIANGLE + "f 1 2 3");
  EXPECT_EQ(scene.material_index, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(scene.warnings.size(), 2u);
}

constexpr const char* RED = "newmtl red\nKd 0.8 0.1 0.1\n";
constexpr const char* BLUE = "newmtl blue\nKd 0.1 0.1 0.8\n";

using Strings = std::vector<std::string>;

TEST_F(ObjNames, BlanksAboutANameDoNotCount) {
  write("m.mtl", "newmtl  red\r\nnewmtl\tblue \nnewmtl  dark green\t\n");
  const Scene scene =
      load("mtllib \t m.mtl  \n" + TRIANGLE +
           "usemtl red\nf 1 2 3\nusemtl   blue\nf 1 2 3\n\tusemtl \t dark green \r\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"red", "blue", "dark green"}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjNames, FileNamesMayHoldBlanks) {
  write("m with  blank.mtl", RED);
  write("b.mtl", BLUE);
  for (const std::string names :
       {"m with  blank.mtl b.mtl", "b.mtl  m with  blank.mtl", "m\\ with\\ \\ blank.mtl b.mtl",
        "\"m with  blank.mtl\" b.mtl", "m with  blank.mtl b.mtl # both"}) {
    const Scene scene =
        load("mtllib " + names + "\n" + TRIANGLE + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
    EXPECT_EQ(names_of(scene), (Strings{"red", "blue"})) << names;
    EXPECT_TRUE(scene.warnings.empty()) << names;
  }
}

TEST_F(ObjNames, SeveralFilesOfOneLineAreRead) {
  write("a", RED);
  write("b.mtl", BLUE);
  const Scene scene = load("mtllib a b.mtl\n" + TRIANGLE + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"red", "blue"}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjNames, BackslashesSeparateFolders) {
  std::filesystem::create_directories(folder_ / "tex" / "sub dir");
  write("tex/sub dir/m.mtl", RED);
  for (const std::string name : {"tex\\sub dir\\m.mtl", ".\\tex\\sub dir\\m.mtl", "tex/sub dir\\m.mtl"}) {
    const Scene scene = load("mtllib " + name + "\n" + TRIANGLE + "usemtl red\nf 1 2 3\n");
    EXPECT_EQ(names_of(scene), Strings{"red"}) << name;
    EXPECT_TRUE(scene.warnings.empty()) << name;
  }
}

TEST_F(ObjNames, OtherLetterCaseIsFoundAndSaidOnce) {
  std::filesystem::create_directory(folder_ / "Tex");
  write("Tex/Red.mtl", RED);
  const Scene scene = load("mtllib tex/RED.MTL\n" + TRIANGLE + "usemtl Red\nf 1 2 3\nusemtl RED\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"red", "red"}));
  EXPECT_EQ(warnings_of(scene),
            (Strings{"scene.obj:1: material file 'tex/RED.MTL' not found, 'Tex/Red.mtl' is used",
                     "scene.obj:5: material 'Red' not found, 'red' is used; 2 such in all"}));
}

TEST_F(ObjNames, AFolderAsWrittenDoesNotHideOneInOtherCase) {
  std::filesystem::create_directory(folder_ / "mats");
  std::filesystem::create_directory(folder_ / "Mats");
  write("Mats/red.mtl", RED);
  const Scene scene = load("mtllib mats/red.mtl\n" + TRIANGLE + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), Strings{"red"});
  EXPECT_EQ(warnings_of(scene),
            Strings{"scene.obj:1: material file 'mats/red.mtl' not found, 'Mats/red.mtl' is used"});
}

// Each of 64 steps may mean two folders, but all lead back to one.
TEST_F(ObjNames, StepsIntoFoldersAndOutAgainLeadToOnePlace) {
  std::filesystem::create_directories(folder_ / "tex");
  std::filesystem::create_directories(folder_ / "Tex");
  write("Red.mtl", RED);
  std::string name;
  for (int i = 0; i < 64; ++i) name += "tex/../";
  const Scene scene = load(TRIANGLE + "mtllib " + name + "red.mtl\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), Strings{"red"});
}

TEST_F(ObjNames, TheFileBesideMayBeInOtherCase) {
  write("Scene.MTL", RED);
  const Scene scene = load(TRIANGLE + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), Strings{"red"});
  EXPECT_EQ(warnings_of(scene), Strings{"scene.obj:4: no mtllib in the file, 'Scene.MTL' is used"});
}

TEST_F(ObjNames, TheSameLettersWinOverOtherCase) {
  write("m.mtl", std::string(RED) + "newmtl Red\nKd 0 0 1\nnewmtl RED\nKd 0 1 0\n");
  const Scene scene =
      load("mtllib m.mtl\n" + TRIANGLE + "usemtl RED\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl Red\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"RED", "red", "Red"}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjNames, ANumberBehindAHashIsPartOfTheName) {
  write("m.mtl", "newmtl Material #25\nKd 1 0 0\nnewmtl red # of the door\nKd 1 0 0\n");
  const Scene scene =
      load("mtllib m.mtl # here\n" + TRIANGLE +
           "usemtl Material #25\nf 1 2 3\nusemtl red # too\nf 1 2 3\nusemtl Material #26\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"Material #25", "red # of the door", "default"}));
}

TEST_F(ObjNames, TheBareNameOfAPathElsewhereIsFoundBesideTheObj) {
  write("My Part.mtl", RED);
  for (const std::string path :
       {"C:\\Users\\me\\My Part.mtl", "/nowhere/at all/My Part.mtl", "../lost/my part.MTL"}) {
    const Scene scene = load("mtllib " + path + "\n" + TRIANGLE + "usemtl red\nf 1 2 3\n");
    EXPECT_EQ(names_of(scene), Strings{"red"}) << path;
    EXPECT_EQ(warnings_of(scene),
              Strings{"scene.obj:1: material file '" + path + "' not found, 'My Part.mtl' is used"});
  }
}

TEST_F(ObjNames, TheStemBesideTheObjTakesThePlaceOfWhatIsMissing) {
  write("scene.mtl", RED);
  const Scene renamed = load("mtllib untitled.mtl\n" + TRIANGLE + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(renamed), Strings{"red"});
  EXPECT_EQ(warnings_of(renamed),
            Strings{"scene.obj:1: material file 'untitled.mtl' not found, 'scene.mtl' is used"});
  const Scene unnamed = load(TRIANGLE + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(unnamed), Strings{"red"});
  EXPECT_EQ(warnings_of(unnamed), Strings{"scene.obj:4: no mtllib in the file, 'scene.mtl' is used"});
  EXPECT_TRUE(load(TRIANGLE + "f 1 2 3\n").warnings.empty());
}

TEST_F(ObjNames, AMaterialMayBeUsedBeforeItsFileIsNamed) {
  write("m.mtl", RED);
  const Scene scene =
      load("g part\nusemtl red\n" + TRIANGLE + "f 1 2 3\nmtllib m.mtl\nf 1 2 3\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"red", "red", "red"}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjNames, ByteOrderMarksAreNoPartOfAName) {
  const std::string mark = "\xEF\xBB\xBF";
  write("m.mtl", mark + RED + mark + BLUE);
  const Scene scene =
      load(mark + "mtllib m.mtl\n" + TRIANGLE + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  EXPECT_EQ(names_of(scene), (Strings{"red", "blue"}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjNames, TheFirstDefinitionOfAMaterialCounts) {
  write("a.mtl", RED);
  write("b.mtl", std::string("newmtl red\nKd 0 0 0\n") + BLUE);
  const Scene scene = load("mtllib a.mtl\nmtllib b.mtl\n" + TRIANGLE + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[1].diffuse, glm::vec3(0.8f, 0.1f, 0.1f));
  EXPECT_EQ(warnings_of(scene),
            Strings{"b.mtl: material 'red' is defined again, the first definition is used"});
}

// By the number of times that a file is asked for, not by the time it takes.
TEST(ObjNamesOnce, AFileThatIsNamedOftenIsReadOnce) {
  std::string obj = TRIANGLE;
  for (int i = 0; i < 3000; ++i) obj += "mtllib m.mtl\nusemtl red\nf 1 2 3\n";
  int asked = 0;
  const Scene scene = parse_obj(obj, "x.obj", [&](const std::string&, MtlMatch) {
    ++asked;
    return FoundMtl{"m.mtl", RED};
  });
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.material_index, std::vector<std::uint32_t>(3000, 1));
}

}  // namespace
}  // namespace coppice
