#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/obj_warnings.h"
#include "scene/scene.h"

namespace coppice {

// The materials of an MTL text in order, as docs/obj.md says. `name` begins the warnings' places. Never
// fails: what is no material is passed over.
std::vector<Material> parse_mtl(std::string_view text, const std::string& name, ObjWarnings& warnings);

}  // namespace coppice
