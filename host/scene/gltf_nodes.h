#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf_document.h"
#include "scene/gltf_rig.h"

namespace coppice {

// The nodes of a file: every node has one parent or none, and none is below itself.
struct GltfNodes {
  std::vector<NodeTransform> transforms;
  std::vector<int> parents;
  std::vector<std::uint32_t> order;  // all, parents before children
  std::vector<std::uint32_t> drawn;  // those of the default scene, depth first
};

// The default scene is the one that the file names, else the first, else all nodes. Throws InputError.
GltfNodes read_gltf_nodes(const GltfDocument& document);

}  // namespace coppice
