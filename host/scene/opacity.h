#pragma once

#include "scene/scene.h"

namespace coppice {

// By its illumination model: `d` says how much light goes through it, refracted, and not how much of the
// surface is there.
inline bool is_glass(const Material& material) {
  return material.illum == 4 || material.illum == 6 || material.illum == 7 || material.illum == 9;
}

// How much of the surface is there where its map of opacity says all: from 0 to 1.
inline float coverage_of(const Material& material) { return is_glass(material) ? 1.0f : material.opacity; }

// Whether rays may pass it as if it were not there.
inline bool lets_rays_through(const Material& material) {
  return material.opacity_map || coverage_of(material) < 1;
}

}  // namespace coppice
