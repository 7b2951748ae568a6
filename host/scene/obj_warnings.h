#pragma once

#include <map>
#include <string>
#include <vector>

namespace coppice {

// What may be odd about an OBJ and its MTL files and is not fatal, what changes the picture most first.
enum class ObjWarning {
  NOT_FINITE,
  NO_FACES,
  POLYGON_CROSSES,
  FREE_FORM,
  MTL_NOT_FOUND,
  MTL_WITHOUT_MATERIAL,
  MATERIAL_NOT_FOUND,
  COLOUR_NOT_READ,
  VERTEX_COLOURS,
  ATTRIBUTE_INDEX,
  TEXTURE_OPTION,
  FACE_TOO_SMALL,
  MATERIAL_TWICE,
  MTL_ELSEWHERE,
  MATERIAL_SPELT_OTHERWISE,
  D_AND_TR,
};

// Gathers warnings into one line a kind: the first of it and their number.
class ObjWarnings {
 public:
  // `place` is file:line, `what` one line of printable text.
  void add(ObjWarning kind, const std::string& place, const std::string& what, std::size_t count = 1);

  // One line a kind, in the order of ObjWarning.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string first;
    std::size_t count = 0;
  };
  std::map<ObjWarning, Entry> entries_;
};

}  // namespace coppice
