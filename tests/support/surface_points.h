#pragma once

#include "support/directions.h"
#include "twins/bsdf.h"
#include "twins/sampler.h"
#include "twins/vectors.h"

namespace coppice {

// Of a normal with components of all sizes and signs.
inline vec3 some_normal() { return twins::unit_vector({0.36f, -0.48f, -0.8f}); }

inline SurfacePoint surface(float roughness, float diffuse, float specular, float transmission = 0,
                            float ior_ratio = 1) {
  return {some_normal(), roughness, vec3(diffuse), ior_ratio, vec3(specular), transmission};
}

inline vec3 view_at(double cosine) { return Directions(some_normal()).at(cosine, 0.7); }

// The means over a stratified set of samples.
struct Means {
  glm::dvec3 with_density{0}, without_density{0};
  double none = 0, delta = 0;  // parts of the samples

  glm::dvec3 all() const { return with_density + without_density; }
};

inline Means means_of(const SurfacePoint& s, const vec3& view, uint count,
                      const twins::BsdfSwitches& switches = {}) {
  Means means;
  for (uint i = 0; i < count; ++i) {
    const BsdfSample next =
        twins::bsdf_sample(s, view, twins::sample_1d(9, i, 0), twins::sample_2d(9, i, 1), switches);
    (next.pdf > 0 ? means.with_density : means.without_density) += glm::dvec3(next.weight);
    means.none += next.flags == BSDF_NONE;
    means.delta += next.flags == BSDF_MIRROR || next.flags == BSDF_TRANSMISSION;
  }
  for (glm::dvec3* const sum : {&means.with_density, &means.without_density}) *sum /= count;
  means.none /= count;
  means.delta /= count;
  return means;
}

}  // namespace coppice
