#pragma once

#include "scene/scene.h"

namespace coppice {

// What a material does with light beside reflecting it diffusely, in the terms of docs/effects.md.

// Whether its surface is a light. What is unlit has its colour without being one.
bool is_emitter(const Material& material);

// 0 to 1. Where a map decides what is metal, which paths do not read, nothing is.
float metalness_of(const Material& material);

// Whether other surfaces are seen in it.
bool is_reflecting(const Material& material);

// The part of light that goes through, refracted: of `illum` 4, 6 and 7. 0 to 1.
float transmission_of(const Material& material);

}  // namespace coppice
