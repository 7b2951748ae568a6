#pragma once

#include "interface/fog.h"

namespace coppice::twins {

// As it lies behind the map of the surroundings.
struct Fog {
  vec3 box_min, box_max, albedo;
  float density, anisotropy;
};

Fog fog_of(const Address<const Surrounding>& surroundings);

// The way of a ray in the fog, from t to t; none where `leaves` is not above `enters`.
struct FogReach {
  float enters, leaves;
};

FogReach reach_of_fog(const Fog& fog, const Ray& ray);
float optical_depth(const Fog& fog, const vec3& direction, const FogReach& reach);

// The part of the light that comes through along the ray.
float transmittance_of(const Fog& fog, const Ray& ray);

// Henyey and Greenstein 1941, by solid angle.
float phase_of(float anisotropy, float cosine);

}  // namespace coppice::twins
