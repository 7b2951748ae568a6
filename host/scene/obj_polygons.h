#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/obj_part.h"
#include "scene/obj_reader.h"
#include "scene/triangulate.h"

namespace coppice {

// Cuts a part's polygons into the mesh's triangles, which keep what the corners have.
class PolygonCutter {
 public:
  PolygonCutter(const ObjPart& part, ObjMesh& mesh)
      : part_(part),
        mesh_(mesh),
        has_attributes_(!part.corner_texcoords.of_corner.empty() || !part.corner_normals.of_corner.empty()) {}

  bool has_attributes() const { return has_attributes_; }

  // Of the corners from the first on, those of the triangle.
  void set_attributes(std::size_t triangle, std::size_t first, glm::uvec3 corners) {
    set(part_.corner_texcoords, mesh_.texcoord_index, triangle, first, corners);
    set(part_.corner_normals, mesh_.normal_index, triangle, first, corners);
  }

  bool cut(std::size_t begin, std::size_t end, std::size_t triangle) {
    cut_.clear();
    const std::span<const std::uint32_t> corners(part_.corners.data() + begin, end - begin);
    if (!has_attributes_) {
      const bool is_whole = triangulate(mesh_.positions, corners, cut_);
      std::copy(cut_.begin(), cut_.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
      return is_whole;
    }
    // The cut depends on the places alone, so it is the same of the corners' numbers in the polygon.
    places_.clear();
    numbers_.clear();
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      numbers_.push_back(i);
      places_.push_back(mesh_.positions[corners[i]]);
    }
    const bool is_whole = triangulate(places_, numbers_, cut_);
    for (const glm::uvec3& t : cut_) {
      mesh_.triangles[triangle] = {corners[t.x], corners[t.y], corners[t.z]};
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
  const bool has_attributes_;
  std::vector<glm::vec3> places_;  // these three are reused
  std::vector<std::uint32_t> numbers_;
  std::vector<glm::uvec3> cut_;
};

}  // namespace coppice
