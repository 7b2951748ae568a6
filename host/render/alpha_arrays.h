#pragma once

#include <span>
#include <string>
#include <vector>

#include "interface/alpha.h"
#include "scene/scene.h"

namespace coppice {

// Where a scene's triangles let rays through, as the stages take it (interface/alpha.h). Made only where
// something asks for it: this is what opens and decodes images of opacity.
struct AlphaArrays {
  std::vector<AlphaTriangle> triangles;  // one a triangle; none where all are solid
  std::vector<AlphaMap> maps;            // at least one where there are triangles
  std::vector<uint> texels;              // four bytes a word
  std::vector<std::string> warnings;     // a line for each image that is missing or broken

  bool empty() const { return triangles.empty(); }
};

// `corners` are those of the scene's triangles (corner_attributes).
AlphaArrays alpha_arrays(const Scene& scene, std::span<const CornerAttributes> corners);

}  // namespace coppice
