#pragma once

#include <vector>

#include "scene/gltf_document.h"
#include "scene/scene.h"

namespace coppice {

// The default material, then those of the file, in the terms of MTL; docs/gltf.md says how. Throws
// InputError.
std::vector<Material> read_gltf_materials(const GltfDocument& document);

}  // namespace coppice
