// The fast reader of plain text and the parser of record give the same scene, whatever the parts.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tiny_obj_loader.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz/obj_input.h"
#include "scene/obj_part.h"
#include "support/obj_folder.h"

namespace coppice {
namespace {

using ObjReadingFiles = ObjFolder;

// A number as files have it.
std::string number(std::mt19937& random) {
  char text[64];
  const double value =
      std::ldexp(static_cast<double>(random()) - 0x1p31, static_cast<int>(random() % 80) - 70);
  const char* const formats[] = {"%.6f", "%g", "%.9g", "%.17g", "%.3e", "%.0f", "%.30f", "%+.4f"};
  std::snprintf(text, sizeof text, formats[random() % (random() % 16 == 0 ? 8 : 7)], value);
  return text;
}

std::string corner(std::mt19937& random, int vertex_count) {
  int index = 1 + static_cast<int>(random() % static_cast<unsigned>(vertex_count));
  if (random() % 4 == 0) index -= vertex_count + 1;
  const std::string i = std::to_string(index);
  switch (random() % 4) {
    case 0:
      return i + "/" + std::to_string(random() % 99);
    case 1:
      return i + "//" + std::to_string(random() % 99);
    case 2:
      return i + "/" + std::to_string(random() % 99) + "/-1";
    default:
      return i;
  }
}

// Mostly plain lines; `odd` of 64 are not.
std::string random_obj(std::mt19937& random, unsigned odd) {
  static const std::vector<std::string> rest = {
      "vt 0.5 0.25", "vn 0 0 1", "g a b", "o x",        "vt 1e-3 -7 0", "vt 2 # c", "vn 0.6 .8 0 1",
      "s off",       "# c",      "",      "usemtl red", "usemtl  blue", "\tvt 1",   "g"};
  static const std::vector<std::string> strange = {
      "l 1 2",         "f 1 2", "f +1 2 3 # c",  "v 0 nan 0", "v 0 0 \\\n 1", "# \\", "v 1 2 3 0.1 0.2 0.3",
      "usemtl RED",    "p 1",   "f 1 2 3 \\\n3", "f 1 2 3#",  "vt nan 1",     "vt",   "vn 1",
      "f 1/x 2/0 3/+1"};
  std::string text;
  int vertex_count = 0;
  for (int line = 0; line < 300; ++line) {
    const unsigned kind = random() % 64;
    if (kind < odd && vertex_count > 2) {
      text += strange[random() % strange.size()];
    } else if (kind < 40 || vertex_count < 4) {
      text += "v " + number(random) + " " + number(random) + "  " + number(random);
      ++vertex_count;
    } else if (kind < 58) {
      text += "f";
      for (unsigned i = 0, n = 3 + random() % 3; i < n; ++i) text += " " + corner(random, vertex_count);
    } else {
      text += rest[random() % rest.size()];
    }
    text += random() % 64 == 0 ? "\r\n" : random() % 8 ? "\n" : " \n";
  }
  return "mtllib m.mtl\n" + text + "\n===\nnewmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";
}

TEST(ObjReading, ReadersAgreeOnRandomFiles) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    const std::string text = random_obj(random, i % 2 ? 8 : 0);
    ASSERT_EQ(complaint_about_obj(text), "") << text;
  }
}

TEST(ObjReading, WhatIsPlainIsReadByTheFastReader) {
  std::string text = "# plain\n" + TRIANGLE;
  text +=
      "v -1.5e-3 2 3 1\r\nvt 0 1\nvn 0 0 1\n\n g a b\ns off\no x\ng\nusemtl red\nmtllib m.mtl\n"
      "f 1 2 3\nf 1/1 2/1 3/1 4/1\nf -1//1 -2//1 -3//1 # c\nf 1/1/1 2/1/1 3/1/1\n";
  ASSERT_TRUE(read_plain_obj_part(text, glm::dvec3{0}));
  for (const std::string odd : {"f 1 2\n", "v 1 2\n", "v 1 2 nan\n", "f 1 2 0\n", "f 1 2 x\n", "f 1 2 3-1\n",
                                "f 1 2/1/1/1 3\n", "l 1 2\n", "v 1 2 3 \\\n"}) {
    EXPECT_FALSE(read_plain_obj_part(text + odd, glm::dvec3{0})) << odd;
  }
}

// Decimals are rounded to the nearest float, as strtof does. tinyobjloader's sums of digits are near.
TEST(ObjReading, CoordinatesAreTheNearestFloats) {
  std::mt19937 random(11);
  for (int i = 0; i < 20000; ++i) {
    std::string text = number(random);
    if (text[0] == '+') text.erase(0, 1);
    const std::optional<ObjPart> plain = read_plain_obj_part("v " + text + " 0 0\n", glm::dvec3{0});
    const float nearest = std::strtof(text.c_str(), nullptr);
    const float record = read_obj_part("v " + text + " 0 0\n", glm::dvec3{0}).positions.at(0).x;
    if (plain) {
      ASSERT_EQ(plain->positions.at(0).x, nearest) << text;
    }
    ASSERT_EQ(record, nearest) << text;
  }
}

// The same faces as tinyobjloader gives by itself, from the whole text.
TEST(ObjReading, FacesAreThoseOfTinyobjloader) {
  std::mt19937 random(13);
  for (int i = 0; i < 50; ++i) {
    std::string text = random_obj(random, 0);
    text.erase(text.find("\n===\n"));
    std::vector<std::vector<int>> faces;
    tinyobj::callback_t callback;
    callback.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
      auto& face = static_cast<std::vector<std::vector<int>>*>(user)->emplace_back();
      for (int corner = 0; corner < count; ++corner) face.push_back(corners[corner].vertex_index);
    };
    std::istringstream stream(text);
    tinyobj::LoadObjWithCallback(stream, callback, &faces);
    const ObjPart part = read_obj_part(text, glm::dvec3{0});
    ASSERT_EQ(part.face_ends.size(), faces.size());
    std::size_t at = 0;
    for (const std::vector<int>& face : faces) {
      for (const int index : face) {
        if (index > 0) {
          ASSERT_EQ(part.corners.at(at), static_cast<std::uint32_t>(index - 1));
        }
        ++at;
      }
    }
    EXPECT_EQ(at, part.corners.size());
  }
}

TEST(ObjReading, ErrorsNameTheLineOfTheFileInEveryPart) {
  std::string text = TRIANGLE;
  for (int i = 0; i < 1000; ++i) text += "f 1 2 3\n";
  const auto no_mtl = [](const std::string&, MtlMatch) { return std::optional<FoundMtl>(); };
  for (const std::size_t part_bytes : {std::size_t{10}, std::size_t{1000}, std::size_t{1} << 20}) {
    const auto error_of = [&](const std::string& end) {
      try {
        parse_obj(text + end, "x.obj", no_mtl, {.part_bytes = part_bytes, .plain = true, .progress = {}});
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    EXPECT_EQ(error_of("f -4 1 2\nf 1 2 x\n"),
              "x.obj:1004: vertex index -4 is out of range: there are 3 vertices before it");
    EXPECT_EQ(error_of("f 1 2 x\nf -4 1 2\n"), "x.obj:1004: 'x' is no vertex index");
    EXPECT_EQ(error_of("f 1 2 4\nf 1 2 5\nv 1 2 3\nf 1 2 5\n"),
              "x.obj:1005: vertex index 5 is out of range: the file has 4 vertices");
    EXPECT_EQ(error_of("v 1 2 3\nf -4 1 4\n"), "");
  }
}

TEST(ObjReading, ProgressReachesTheEnd) {
  std::atomic<int> calls = 0, ends = 0;
  const auto no_mtl = [](const std::string&, MtlMatch) { return std::optional<FoundMtl>(); };
  parse_obj(TRIANGLE + "f 1 2 3\n", "x.obj", no_mtl,
            {.part_bytes = 8, .plain = true, .progress = [&](double done) {
               ++calls;
               if (done == 1) ++ends;
             }});
  EXPECT_EQ(calls, 4);
  EXPECT_EQ(ends, 1);
}

// Neither hangs on what never ends.
TEST_F(ObjReadingFiles, OnlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_ / "pipe.mtl").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.obj");
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.mtl");
  EXPECT_EQ(error_of(folder_ / "pipe.obj"), "pipe.obj: not a regular file");
  EXPECT_EQ(error_of(folder_ / "zero.obj"), "zero.obj: not a regular file");
  const Scene scene = load("mtllib pipe.mtl zero.mtl /dev/zero\n" + TRIANGLE + "f 1 2 3\n");
  EXPECT_EQ(warnings_of(scene),
            std::vector<std::string>{"scene.obj:1: material file 'pipe.mtl' not found; 3 such in all"});
}

}  // namespace
}  // namespace coppice
