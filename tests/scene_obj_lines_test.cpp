// What ends a line, continues it, or is no part of it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/obj_folder.h"

namespace coppice {
namespace {

using ObjLines = ObjFolder;

TEST_F(ObjLines, ReadsEveryLineEnding) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const Scene scene = load("v 0 0 0" + end + "v 1 0 0" + end + end + "\t v 0 1 0" + end + "f 1 2 3 ");
    EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
  }
}

TEST_F(ObjLines, ReadsContinuedLinesCommentsAndAByteOrderMark) {
  const Scene scene =
      load("\xEF\xBB\xBFv 0 0 \\\r\n0\nv 1 0 0 # c\nv 0 1 0\n# C:\\folder\\\nf 1 2 \\\n 3 # 4\n");
  EXPECT_EQ(scene.positions.size(), 3u);
  EXPECT_EQ(scene.indices, (std::vector<glm::uvec3>{{0, 1, 2}}));
}

using FaceCorners = std::vector<glm::uvec3>;

TEST_F(ObjLines, EveryLineEndMayFollowABackslash) {
  for (const std::string end : {"\n", "\r\n", "\r", "\r\r\n", " \n", " \t\r\n"}) {
    const Scene scene = load(TRIANGLE + "v 1 \\" + end + "1\\" + end + " 0\nf 1 2 \\" + end + " 3\nf 2 4\\" +
                             end + "\\" + end + " 3\n");
    EXPECT_EQ(scene.indices, (FaceCorners{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST_F(ObjLines, ABackslashThatEndsTheFileContinuesNothing) {
  for (const std::string end : {"\\", "\\\n", " \\", "\\ ", "\\\r\n"}) {
    EXPECT_EQ(load(TRIANGLE + "f 1 2 3" + end).indices, (FaceCorners{{0, 1, 2}}));
  }
}

TEST_F(ObjLines, ABackslashThatEndsACommentContinuesNothing) {
  for (const std::string comment : {"# C:\\parts\\", "\t # C:\\parts\\", "#\\", "# a \\ ", "##\\"}) {
    for (const std::string end : {"\n", "\r\n"}) {
      const Scene scene =
          load("v 0 0 0 " + comment + end + "v 1 0 0" + comment + end + "v 0 1 0" + end + comment + end +
               "v 1 1 0" + end + "g part " + comment + end + "f 1 2 3 " + comment + end + "f 2 4 3" +
               comment + end + "f 1 \\" + end + "2 4 " + comment + end + "f 1 4 3" + end);
      EXPECT_EQ(scene.indices, (FaceCorners{{0, 1, 2}, {1, 3, 2}, {0, 1, 3}, {0, 3, 2}})) << comment;
      EXPECT_EQ(scene.positions.size(), 4u) << comment;
    }
  }
}

TEST_F(ObjLines, ZeroBytesThatPadTheFileAreNoText) {
  for (const std::size_t count : {1u, 511u, 100000u}) {
    for (const std::string end : {"", "\n", "\r\n", "\\\n", " "}) {
      const std::string padding = std::string(count, '\0');
      EXPECT_EQ(load(TRIANGLE + "f 1 2 3" + end + padding).indices.size(), 1u) << count;
      EXPECT_EQ(load(TRIANGLE + "f 1 2 3" + end + padding + "\n").indices.size(), 1u) << count;
    }
  }
  const std::string binary = "bad.obj: a binary file, not an OBJ file";
  EXPECT_EQ(error_in(TRIANGLE + std::string(10, '\0') + "f 1 2 3\n"), binary);
}

TEST_F(ObjLines, IndicesMayHaveAPlusSign) {
  EXPECT_EQ(load(TRIANGLE + "f +1 +2 +3\nf +2/+1 3//+1 -3/1/+1\n").indices,
            (FaceCorners{{0, 1, 2}, {1, 2, 0}}));
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 +-3\n"), "bad.obj:4: '+-3' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 +\n"), "bad.obj:4: '+' is no vertex index");
  EXPECT_EQ(error_in(TRIANGLE + "f 1 2 ++3\n"), "bad.obj:4: '++3' is no vertex index");
}

TEST_F(ObjLines, AFaceWithFewerThanThreeCornersIsLeftOut) {
  const Scene scene = load(TRIANGLE + "f 1 2 3\nf 1 2 # 3\nf\nf 3\nf 9 9\nf 3 2 1\n");
  EXPECT_EQ(scene.indices, (FaceCorners{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(
      warnings_of(scene),
      std::vector<std::string>{"scene.obj:5: face with fewer than three corners, left out; 4 such in all"});
}

TEST_F(ObjLines, LineNumbersCountContinuedLines) {
  for (const std::string end : {"\n", "\r\n", "\r", "\r\r\n"}) {
    EXPECT_EQ(error_in("v 0 \\" + end + " 0 \\" + end + " 0" + end + "f 1 \\" + end + " 1 9" + end),
              "bad.obj:4: vertex index 9 is out of range: the file has 1 vertex");
  }
}

}  // namespace
}  // namespace coppice
