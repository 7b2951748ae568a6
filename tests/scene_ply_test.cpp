// PLY files, ASCII and binary.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/input_error.h"
#include "scene/load_ply.h"
#include "scene/scene_source.h"
#include "support/obj_folder.h"

namespace coppice {
namespace {

using LoadPly = ObjFolder;

std::string ply_header(const std::string& format, int vertices, int faces) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ply_error_of(const std::string& text) {
  try {
    parse_ply(text, "m.ply");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The bytes of a number, the last first where `is_big`.
template <class T>
std::string ply_bytes(T value, bool is_big) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (is_big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

const std::string PLY_SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::vector<glm::vec3> PLY_CORNERS = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
using Triangles = std::vector<glm::uvec3>;

TEST(Ply, AsciiWithPolygons) {
  const Scene scene = parse_ply(ply_header("ascii", 4, 2) + PLY_SQUARE + "4 0 1 2 3\n3 0 2 1\n", "m.ply");
  EXPECT_EQ(scene.positions, PLY_CORNERS);
  EXPECT_EQ(scene.indices, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 2, 1}}));
  EXPECT_EQ(scene.material_index.size(), 3u);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(parse_ply(ply_header("ascii", 4, 1) + "\n" + PLY_SQUARE + "\n4 0 1 2 3", "m.ply").indices.size(),
            2u);
}

TEST(Ply, EveryLineEnding) {
  const std::string text = ply_header("ascii", 4, 1) + PLY_SQUARE + "4 0 1 2 3\n";
  for (const std::string end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(parse_ply(other, "m.ply").positions, PLY_CORNERS);
  }
}

TEST(Ply, BinaryOfBothByteOrders) {
  for (const bool is_big : {false, true}) {
    std::string text = ply_header(is_big ? "binary_big_endian" : "binary_little_endian", 4, 1);
    for (const glm::vec3 corner : PLY_CORNERS) {
      for (int axis = 0; axis < 3; ++axis) text += ply_bytes(corner[axis], is_big);
    }
    text += '\4';
    for (int i = 0; i < 4; ++i) text += ply_bytes(i, is_big);
    const Scene scene = parse_ply(text, "m.ply");
    EXPECT_EQ(scene.positions, PLY_CORNERS);
    EXPECT_EQ(scene.indices, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    for (std::size_t size = text.size() - 1; size > text.size() - 60; --size) {
      EXPECT_TRUE(ply_error_of(text.substr(0, size)).starts_with("m.ply:")) << size;
    }
    EXPECT_EQ(ply_error_of(text.substr(0, text.size() - 2)),
              "m.ply: face 0: the file ends, expected 4 more bytes");
  }
}

// Every type, other elements and properties, faces before vertices.
TEST(Ply, EveryTypeAndWhatIsReadOver) {
  std::string text =
      "ply\nformat binary_big_endian 1.0\nobj_info none\nelement face 1\nproperty int8 flags\n"
      "property list uint16 uint8 vertex_index\nproperty list char double more\nelement vertex 3\n"
      "property float64 y\nproperty ushort x\nproperty short z\nproperty uchar red\nelement nothing 9\n"
      "element edge 2\nproperty uint32 a\nend_header\n";
  text += '\1' + ply_bytes<std::uint16_t>(3, true) + std::string("\2\1\0", 3) + '\1' + ply_bytes(2.5, true);
  for (int v = 0; v < 3; ++v) {
    text += ply_bytes(v + 0.5, true) +
            ply_bytes<std::uint16_t>(static_cast<std::uint16_t>(65000 + 5 * v * v), true) +
            ply_bytes<std::int16_t>(static_cast<std::int16_t>(-3 * v), true) + '\7';
  }
  text += std::string(8, 'x');
  const Scene scene = parse_ply(text, "m.ply");
  EXPECT_EQ(scene.indices, (Triangles{{2, 1, 0}}));
  ASSERT_EQ(scene.positions.size(), 3u);
  EXPECT_EQ(to_file(scene, scene.positions[2]), glm::dvec3(65020, 2.5, -6));
  ASSERT_GE(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "m.ply: vertex colours are not used");
}

TEST(Ply, StripsOfTriangles) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  EXPECT_EQ(parse_ply(text + PLY_SQUARE + "8 0 1 2 3 -1 3 2 1\n", "m.ply").indices,
            (Triangles{{0, 1, 2}, {1, 3, 2}, {3, 2, 1}}));
}

TEST(Ply, NumbersThatAreNoneMakeInactiveTriangles) {
  EXPECT_EQ(count_inactive(
                parse_ply(ply_header("ascii", 3, 1) + "nan 0 0\n1e999 0 0\n+1 -inf 2\n3 0 1 2\n", "m.ply")),
            1u);
}

TEST_F(LoadPly, IsOpenedByItsName) {
  const Scene scene =
      open_scene(write("a.PLY", ply_header("ascii", 4, 1) + PLY_SQUARE + "4 0 1 2 3\n").string());
  EXPECT_EQ(scene.name, "a");
  EXPECT_EQ(scene.indices.size(), 2u);
  EXPECT_TRUE(parse_ply(ply_header("ascii", 1, 0) + "0 0 0\n", "m.ply").indices.empty());
}

TEST(Ply, EveryErrorNamesItsPlace) {
  const std::string ascii = ply_header("ascii", 4, 1);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = ascii + PLY_SQUARE + "4 0 1 2 3\n";
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"plo\n", "m.ply:1: no PLY file, expected 'ply' as the first line"},
      {"", "m.ply:1: no PLY file, expected 'ply' as the first line"},
      {"ply\nformat ascii 1.0\n", "m.ply:2: ends in the header, expected 'end_header'"},
      {with("format ascii 1.0\n", ""), "m.ply:9: no format, expected a line 'format ascii 1.0' or the like"},
      {with("ascii", "text"),
       "m.ply:2: format of no known kind, expected ascii, binary_little_endian or binary"},
      {with("comment", "coment"),
       "m.ply:3: 'coment', expected format, element, property, comment or end_header"},
      {with("vertex 4", "vertex four"), "m.ply:4: element without a count, expected 'element NAME COUNT'"},
      {with("vertex 4", "vertex 99999999999"),
       "m.ply:10: element vertex 99999999999, expected no more than the"},
      {with("float x", "real x"), "m.ply:5: type 'real', expected char, uchar"},
      {with("property float x\n", ""), "m.ply: element vertex has no property 'x'"},
      {with("list uchar", "list float"), "m.ply:9: list whose count is no integer"},
      {with("list uchar int", "list uchar"),
       "m.ply:9: expected 'property TYPE NAME' or 'property list TYPE TYPE"},
      {with("element vertex 4\n", ""), "m.ply:4: property before any element"},
      {with("1 1 0", "1 one 0"), "m.ply:13: vertex 2: 'one', expected a number"},
      {with("1 1 0", "1 1"), "m.ply:13: vertex 2: the line ends, expected another number"},
      {with("1 1 0", "1 1 0 0"), "m.ply:13: vertex 2: more numbers in the line than properties"},
      {with("4 0 1 2 3", "4 0 1 2 4"), "m.ply:15: face 0: vertex 4, expected one below 4"},
      {with("4 0 1 2 3", "4 0 1 2 -1"), "m.ply:15: face 0: vertex -1, expected one below 4"},
      {with("4 0 1 2 3", "4 0 1 2 1.5"), "m.ply:15: face 0: vertex 1.500000, expected one below 4"},
      {with("4 0 1 2 3", "-4 0 1 2"), "m.ply:15: face 0: list of -4.000000, expected a count of at least 0"},
      {with("4 0 1 2 3", "400 0 1 2"), "m.ply:15: face 0: list of 400.000000 is longer than the file"},
      {with("4 0 1 2 3\n", ""), "m.ply:15: face 0: the file ends, expected another number"},
  };
  for (const auto& [text, says] : faults) {
    const std::string message = ply_error_of(text);
    EXPECT_TRUE(message.starts_with(says)) << "expected " << says << ", got " << message;
  }
}

}  // namespace
}  // namespace coppice
