#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/face_digest.h"
#include "scene/obj_part.h"
#include "scene/obj_warnings.h"
#include "scene/scene.h"

namespace coppice {

// How a text is read. The result is the same in every bit, whatever the options; tests compare them.
struct ObjReading {
  std::size_t part_bytes = std::size_t{1} << 20;  // read at once by one thread
  bool plain = true;  // whether plain parts go to the fast reader; else all to the parser of record
  std::function<void(double done)> progress;  // called with the share that is done, from any thread
};

// What an OBJ says of its mesh and its materials' names.
struct ObjMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  // As in Scene; the index vectors are empty where no corner has any.
  std::vector<glm::vec2> texcoords;
  std::vector<glm::uvec3> texcoord_index;
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> normal_index;
  FaceDigest faces;
  std::vector<ObjPart::Library> libraries;  // with lines of the file
  struct MaterialUse {
    std::size_t triangle;  // the first that has it
    std::string name;
    std::size_t line;  // of the file
  };
  std::vector<MaterialUse> uses;
};

// Reads a text in parallel. `name` begins the messages; `offset` is subtracted from all coordinates, in
// double, before they are rounded. Throws InputError as load_obj says.
ObjMesh read_obj_mesh(std::string_view text, const std::string& name, glm::dvec3 offset,
                      const ObjReading& reading, ObjWarnings& warnings);

}  // namespace coppice
