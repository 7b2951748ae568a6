#pragma once

#include "interface/paths.h"

namespace coppice::twins {

// What a surface reflects and transmits. Lambert's diffuse lobe; a mirror or GGX (Walter et al. 2007, masking
// of Heitz 2014) with Schlick's Fresnel term of `specular`; a dielectric's transmission, through the facets
// of a rough surface, with the exact Fresnel term, which where `specular` is not black is then that of the
// reflecting lobe as well. Visible facets are sampled as by Dupuy and Benyoub 2023.
//
// `view` and `light` are unit and point away from the surface. The view is on the side of the normal, else
// there is nothing. Weights of transmission are those of radiance divided by the square of the index of
// refraction. Mirrors and transmission are not in terms, value and pdf; their samples have pdf 0.

// What is compiled into a kernel.
struct BsdfSwitches {
  bool diffuse_lobe = true;  // sampled; it counts in any case
  bool reflects = true;      // there are surfaces with a reflecting lobe
  bool transmits = true;     // there are surfaces that transmit
};

BsdfTerms bsdf_terms(const SurfacePoint& surface, const vec3& view, const vec3& light,
                     const BsdfSwitches& switches = {});

// Of the terms, what bsdf_sample samples by their pdf: what a sampled light has to share with a path that
// meets it, by the balance or the power heuristic. The rest counts in full.
vec3 bsdf_sampled(const BsdfTerms& terms, const BsdfSwitches& switches = {});

// BSDF times cosine to the light.
vec3 bsdf_value(const SurfacePoint& surface, const vec3& view, const vec3& light,
                const BsdfSwitches& switches = {});

// By solid angle, of the lights that bsdf_sample finds.
float bsdf_pdf(const SurfacePoint& surface, const vec3& view, const vec3& light,
               const BsdfSwitches& switches = {});

// `lobe` and `u` are in [0, 1), independent.
BsdfSample bsdf_sample(const SurfacePoint& surface, const vec3& view, float lobe, const glm::vec2& u,
                       const BsdfSwitches& switches = {});

}  // namespace coppice::twins
