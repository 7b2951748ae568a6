#pragma once

#include "interface/paths.h"
#include "twins/bsdf.h"

namespace coppice::twins {

// A surface as seen from one side by one view: the parts of its lobes, and their choice.
class BsdfLobes {
 public:
  BsdfLobes(const SurfacePoint& surface, const vec3& view, const BsdfSwitches& switches);

  // F of light at this cosine is F0 + (1 - F0) rise.
  float rise(float cosine) const;
  vec3 reflectance(float cosine) const;

  // GGX by solid angle, of a unit vector.
  float facet_density(const vec3& facet) const;
  // Smith's masking is 2 cosine / (cosine + slope).
  float slope(float cosine) const;

  bool seen() const { return cos_view >= BSDF_MIN_COSINE; }
  bool is_smooth() const { return alpha == 0; }

  vec3 normal;
  float cos_view;
  float alpha, alpha_squared;
  float ior_ratio;
  float transmission;
  bool reflects, transmits;
  vec3 at_normal;  // F0
  vec3 diffuse;    // albedo (1 - transmission) (1 - F0)
  float rise_to_view;
  vec3 to_view;  // F of the view's cosine
  float pick_diffuse = 0, pick_reflecting = 0, pick_transmitting = 0;

 private:
  void pick_by_shares(bool diffuse_lobe);
};

// Snell: the square of the refracted cosine, not positive where reflection is total.
float refracted_cosine_square(float cosine, float ior_ratio);
float dielectric_reflectance(float cosine, float ior_ratio);

}  // namespace coppice::twins
