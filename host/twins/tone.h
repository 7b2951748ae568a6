#pragma once

#include "interface/shade.h"

namespace coppice::twins {

// What a display is to show of linear radiance, by a curve, TONE_: see docs/effects.md#tone-mapping.
vec3 tone_of(const vec3& radiance, uint curve);

}  // namespace coppice::twins
