#pragma once

#include <cstdint>
#include <vector>

#include "scene/obj_part.h"
#include "scene/obj_reader.h"
#include "scene/triangulate.h"

namespace coppice {

// Cuts a part's polygons into the mesh's triangles, which keep what the corners have.
class PolygonCutter {
 public:
  PolygonCutter(const ObjPart& part, ObjMesh& mesh) : part_(part), mesh_(mesh) {}

  // Of the corners from the first on, those of the triangle.
  void set_attributes(std::size_t triangle, std::size_t first, glm::uvec3 corners) {
    set(part_.corner_texcoords, mesh_.texcoord_index, triangle, first, corners);
    set(part_.corner_normals, mesh_.normal_index, triangle, first, corners);
  }

  bool cut(std::size_t begin, std::size_t end, std::size_t triangle) {
    // The cut depends on the places alone, so it is the same of the corners' numbers in the polygon.
    places_.clear();
    numbers_.clear();
    cut_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      numbers_.push_back(static_cast<std::uint32_t>(i - begin));
      places_.push_back(mesh_.positions[part_.corners[i]]);
    }
    const bool is_whole = triangulate(places_, numbers_, cut_);
    for (const glm::uvec3& t : cut_) {
      const auto vertex = [&](std::uint32_t corner) { return part_.corners[begin + corner]; };
      mesh_.triangles[triangle] = {vertex(t.x), vertex(t.y), vertex(t.z)};
      set_attributes(triangle++, begin, t);
    }
    return is_whole;
  }

 private:
  static void set(const ObjAttribute& from, std::vector<glm::uvec3>& to, std::size_t triangle,
                  std::size_t first, glm::uvec3 corners) {
    if (from.of_corner.empty()) return;
    const std::uint32_t* const of_face = from.of_corner.data() + first;
    to[triangle] = {of_face[corners.x], of_face[corners.y], of_face[corners.z]};
  }

  const ObjPart& part_;
  ObjMesh& mesh_;
  std::vector<glm::vec3> places_;  // these three are reused
  std::vector<std::uint32_t> numbers_;
  std::vector<glm::uvec3> cut_;
};

}  // namespace coppice
