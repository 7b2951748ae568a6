#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_accessors.h"
#include "scene/gltf_rig.h"
#include "scene/scene_notes.h"

namespace coppice {

// The tracks of the animations that play: all that move different things play together, and one that moves
// what an earlier one moves is left out (noted). With a `wanted` one, by its name or else its index, only
// that. Throws InputError, also where there is no wanted one.
std::vector<NodeTrack> read_gltf_tracks(const GltfDocument& document, const GltfAccessors& accessors,
                                        const std::optional<std::string>& wanted, SceneNotes& notes);

// How many morph targets a node has, the same for all primitives of its mesh.
std::size_t target_count(const GltfDocument& document, std::size_t node);

}  // namespace coppice
