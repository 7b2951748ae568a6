#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/motion.h"

namespace coppice {

// What an object's "deform", at `pointer` in the file `name`, makes of its mesh: of all its vertices. Where
// it comes in pieces the mesh's triangles no longer share vertices. Throws InputError.
Deformation read_deformation(const nlohmann::json& from, Scene& mesh, const std::string& name,
                             const std::string& pointer);

// Behind what else moves the mesh's vertices.
void add_deformation(Scene& mesh, const Deformation& deformation);

}  // namespace coppice
