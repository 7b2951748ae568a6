#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace coppice {

// The text of an OBJ file that has been checked: every face has at least three vertices, every vertex index
// is within the file, every vertex has three coordinates. A parser that trusts its input may read it.
struct ObjText {
  std::string text;  // continued lines joined; coordinates, normals and comments after a face blanked out
  std::vector<glm::vec3>
      positions;  // of the `v` statements in order; non-finite where the text is no finite float
  std::vector<std::string> warnings;  // one line each
};

// The bytes of a file that may be an OBJ. Throws InputError as load_obj says.
std::string read_obj_file(const std::filesystem::path& path);

// Checks a text in one pass. `name` begins the messages. `offset` is subtracted from all coordinates, in
// double, before they are rounded. Throws InputError as load_obj says.
ObjText check_obj_text(std::string text, const std::string& name, glm::dvec3 offset = glm::dvec3{0.0});

}  // namespace coppice
