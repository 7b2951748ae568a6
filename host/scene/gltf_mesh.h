#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "scene/gltf_accessors.h"
#include "scene/scene_notes.h"

namespace coppice {

// What is read of a primitive of a mesh, in the mesh's own space.
struct GltfPrimitive {
  std::string pointer;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;                 // in range
  std::vector<glm::vec2> texcoords;                  // one a vertex, or none
  std::vector<glm::vec3> normals;                    // one a vertex, or none
  std::uint32_t material = 0;                        // into the result of read_gltf_materials
  std::vector<std::vector<glm::vec3>> targets;       // morph targets, one offset a vertex; empty for all 0
  std::vector<std::array<std::uint16_t, 4>> joints;  // of the skin; one a vertex if asked for, in range
  std::vector<glm::vec4> weights;                    // that add up to 1
};

// Reads primitive `index` of a mesh; for a skin of `skin_joints` joints if not 0. Lines and points have no
// triangles (noted).
GltfPrimitive read_gltf_primitive(const GltfDocument& document, const GltfAccessors& accessors,
                                  std::size_t mesh, std::size_t index, std::size_t skin_joints,
                                  SceneNotes& notes);

}  // namespace coppice
