#pragma once

#include <optional>
#include <string>

#include "scene/gltf_document.h"
#include "scene/scene.h"

namespace coppice {

// The default scene of a document as one mesh. `offset` is subtracted from all that stands still.
Scene flatten_gltf(const GltfDocument& document, const std::optional<std::string>& animation,
                   glm::dvec3 offset);

}  // namespace coppice
