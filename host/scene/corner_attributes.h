#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>

#include "scene/scene.h"

namespace coppice {

// Texture coordinates and normals of triangles' corners (Scene::texcoords and the members that follow it),
// where scenes are put together.

// How triangles come into another scene.
struct CornerPlacement {
  glm::dmat4 transform{1.0};   // of their positions: normals turn by the transpose of its inverse
  bool swaps_corners = false;  // the second and the third, as of what is mirrored
  bool keeps_normals = true;   // not those of what moves by its vertices
};

// The unit normal of a surface whose points `transform` moves; as it is where that has no direction or the
// transform is the identity.
glm::vec3 moved_normal(const glm::dmat4& transform, glm::vec3 normal);

// Gives the last `count` triangles of `to`, which have no attributes yet, those of the triangles of `from`
// from `first` on. Of what `from` has none of, nothing is added unless other triangles have some.
void append_corner_attributes(const Scene& from, std::size_t first, std::size_t count,
                              const CornerPlacement& placement, Scene& to);

void drop_normals(Scene& scene);

}  // namespace coppice
