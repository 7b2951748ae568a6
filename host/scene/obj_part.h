#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// How often something was found in a part, and the line of the first.
struct ObjFinding {
  std::size_t count = 0, line = 0;
  void add(std::size_t at_line) {
    if (count++ == 0) line = at_line;
  }
};

// What faces' corners have of one kind, texture coordinates or normals, beside their places. `of_corner` is
// empty, or has one index a corner, counted as the vertices' are, NO_ATTRIBUTE where there is none.
struct ObjAttribute {
  std::vector<std::uint32_t> of_corner;
  std::vector<std::uint32_t> relative;  // places in it of those that count from the part's begin

  // The index as written, 0 for none, of the corner that is `corner`-th in the part. `before` is the number
  // of the part's coordinates, or normals, before it.
  void add(std::size_t corner, std::int32_t index, std::size_t before) {
    if (index == 0 && of_corner.empty()) return;
    of_corner.resize(corner, NO_ATTRIBUTE);
    if (index < 0) relative.push_back(static_cast<std::uint32_t>(corner));
    of_corner.push_back(index == 0  ? NO_ATTRIBUTE
                        : index > 0 ? static_cast<std::uint32_t>(index - 1)
                                    : static_cast<std::uint32_t>(before) + static_cast<std::uint32_t>(index));
  }
};

// What a part of an OBJ file says, read without what stands before it. Lines count from 1 at the part's
// beginning, vertices from 0 at the file's or, those that are counted backwards, at the part's.
struct ObjPart {
  std::size_t line_count = 0;
  bool recognised = false;  // whether any statement is one of the format's

  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> corners;        // vertex indices of all faces, each face after the other
  std::vector<std::uint32_t> relative;       // places in `corners` of those that count from the part's begin
  std::vector<std::uint32_t> face_ends;      // for each face, where it ends in `corners`
  std::vector<std::uint32_t> polygon_lines;  // of each face with more than three corners
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec3> normals;
  ObjAttribute corner_texcoords, corner_normals;

  struct MaterialUse {
    std::size_t face;  // the first that has it
    std::string name;
    std::size_t line;
  };
  std::vector<MaterialUse> uses;  // usemtl
  struct Library {
    std::string names;  // the line's rest
    std::size_t line;
  };
  std::vector<Library> libraries;  // mtllib

  // Faces that count back beyond the part's begin, each by more than those before.
  struct Backward {
    std::int64_t vertices_needed;  // before the part
    std::int32_t index;            // as written
    std::int64_t vertices_before;  // the face, in the part
    std::size_t line;
  };
  std::vector<Backward> backward;
  std::int32_t greatest_index = 0;  // as written
  std::size_t greatest_line = 0;

  ObjFinding small_faces, non_finite, coloured, free_form, odd_attributes;

  bool is_binary = false;  // holds a zero byte; nothing else is read then
  struct Error {
    std::size_t line;
    std::string what;
  };
  std::optional<Error> error;  // nothing after it is read

  // Notes an index, not 0, for the check of its range.
  void note_index(std::int32_t index, std::size_t line) {
    if (index > greatest_index) {
      greatest_index = index;
      greatest_line = line;
    }
    if (index > 0) return;
    const auto before = static_cast<std::int64_t>(positions.size());
    const std::int64_t needed = -std::int64_t{index} - before;
    if (needed > (backward.empty() ? 0 : backward.back().vertices_needed)) {
      backward.push_back({needed, index, before, line});
    }
  }

  // Adds a corner to the face that end_face ends. `before` is the number of the part's vertices before it.
  void add_corner(std::int32_t index, std::size_t before) {
    if (index > 0) {
      corners.push_back(static_cast<std::uint32_t>(index - 1));
    } else {
      relative.push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back(static_cast<std::uint32_t>(before) + static_cast<std::uint32_t>(index));
    }
  }

  void end_face() { face_ends.push_back(static_cast<std::uint32_t>(corners.size())); }
};

// What follows the coordinates of a vertex: a weight, or a colour, or both.
bool is_vertex_colour(std::string_view rest);

// The float nearest to a word less `offset`; infinite where it is too large, NaN where the word is no number.
float parse_coordinate(std::string_view word, double offset);

// Reads a part, any text of whole statements. Coordinates are ours, faces are checked and then read by
// tinyobjloader.
ObjPart read_obj_part(std::string text, glm::dvec3 offset);

// The same of parts that are plain: v, vt, vn, f, g, o, s, usemtl and mtllib with numbers as they are usually
// written, comments, no continued lines. Nothing of others. Several times faster, and equal in every bit.
std::optional<ObjPart> read_plain_obj_part(std::string_view text, glm::dvec3 offset);

}  // namespace coppice
