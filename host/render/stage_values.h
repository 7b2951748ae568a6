#pragma once

#include "interface/lights.h"
#include "scene/scene.h"

namespace coppice {

// Values as stages take them, which compare with 0 and know no denormals and no infinite places.

// Denormals and -0 as +0.
vec3 flush_to_zero(vec3 v);

LightSource light_source(const Light& light);

}  // namespace coppice
