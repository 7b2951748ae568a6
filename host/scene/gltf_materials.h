#pragma once

#include <vector>

#include "scene/gltf_document.h"
#include "scene/scene.h"
#include "scene/scene_notes.h"

namespace coppice {

// The default material, then those of the file, in the terms of MTL; docs/gltf.md says how. What is not used
// of their textures is noted. Throws InputError.
std::vector<Material> read_gltf_materials(const GltfDocument& document, SceneNotes& notes);

}  // namespace coppice
