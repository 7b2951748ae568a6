#pragma once

#include <glm/vec2.hpp>

#include "interface/types.h"

namespace coppice::twins {

// Right-handed around a unit normal: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
struct TangentFrame {
  vec3 tangent, bitangent, normal;

  explicit TangentFrame(const vec3& normal);

  vec3 to_world(float x, float y, float z) const;  // of unit length
};

// By the cosine to the normal, of u in [0, 1): a point of the disk (disk_at), lifted to the hemisphere.
vec3 cosine_direction(const vec3& normal, const glm::vec2& u);

}  // namespace coppice::twins
