#include "twins/bsdf_lobes.h"

#include <algorithm>
#include <cmath>

#include "twins/vectors.h"

namespace coppice::twins {

namespace {

float within_one(float x) { return std::min(std::max(x, 0.0f), 1.0f); }
vec3 within_one(const vec3& v) { return {within_one(v.x), within_one(v.y), within_one(v.z)}; }
float brightest(const vec3& v) { return std::max(std::max(v.x, v.y), v.z); }

}  // namespace

float refracted_cosine_square(float cosine, float ior_ratio) {
  const float scaled = ior_ratio * cosine;
  return (1 - ior_ratio) * (1 + ior_ratio) + scaled * scaled;
}

float dielectric_reflectance(float cosine, float ior_ratio) {
  const float square = refracted_cosine_square(cosine, ior_ratio);
  if (square <= 0) return 1;
  const float refracted = std::sqrt(square);
  const float n_i = ior_ratio * cosine, n_t = ior_ratio * refracted;
  const float s_polarized = (n_i - refracted) / (n_i + refracted);
  const float p_polarized = (n_t - cosine) / (n_t + cosine);
  return 0.5f * (s_polarized * s_polarized + p_polarized * p_polarized);
}

BsdfLobes::BsdfLobes(const SurfacePoint& surface, const vec3& view, const BsdfSwitches& switches)
    : normal(surface.normal), cos_view(dot_product(surface.normal, view)) {
  const float roughness = within_one(surface.roughness), squared = roughness * roughness;
  alpha = squared < BSDF_MIRROR_ALPHA ? 0.0f : squared;
  alpha_squared = alpha * alpha;
  ior_ratio = std::clamp(surface.ior_ratio, 1.0f / 16, 16.0f);
  transmission = switches.transmits ? within_one(surface.transmission) : 0.0f;
  transmits = transmission > 0;
  const vec3 specular = within_one(surface.specular);
  reflects = switches.reflects && brightest(specular) > 0;
  if (transmits && ior_ratio == 1) reflects = false;  // no boundary of media
  at_normal = vec3(0);
  if (reflects && transmits) {
    const float amplitude = (ior_ratio - 1) / (ior_ratio + 1);
    at_normal = vec3(amplitude * amplitude);
  } else if (reflects) {
    at_normal = specular;
  }
  diffuse = within_one(surface.diffuse) * (1 - transmission) * (1.0f - at_normal);
  rise_to_view = rise(cos_view);
  to_view = reflectance(cos_view);
  pick_by_shares(switches.diffuse_lobe);
}

float BsdfLobes::rise(float cosine) const {
  if (!reflects) return 0;
  if (transmits) {
    const float f0 = at_normal.x;
    return within_one((dielectric_reflectance(std::max(cosine, 0.0f), ior_ratio) - f0) / (1 - f0));
  }
  const float m = 1 - within_one(cosine);
  return m * m * (m * m) * m;
}

vec3 BsdfLobes::reflectance(float cosine) const { return at_normal + (1.0f - at_normal) * rise(cosine); }

float BsdfLobes::facet_density(const vec3& facet) const {
  const vec3 across = cross_product(normal, facet);
  const float cosine = dot_product(normal, facet);
  const float spread =
      std::max(dot_product(across, across) + alpha_squared * (cosine * cosine), alpha_squared);
  return alpha_squared * ONE_BY_PI / (spread * spread);
}

float BsdfLobes::slope(float cosine) const {
  return std::sqrt(std::max(alpha_squared + (1 - alpha_squared) * (cosine * cosine), 0.0f));
}

void BsdfLobes::pick_by_shares(bool diffuse_lobe) {
  const float diffuse_share = diffuse_lobe ? brightest(diffuse) * (1 - rise_to_view) : 0.0f;
  float reflecting_share = reflects ? brightest(to_view) : 0.0f;
  float transmitting_share = transmission * ((1 - at_normal.x) * (1 - rise_to_view));
  if (!is_smooth()) {
    if (reflects) reflecting_share = std::max(reflecting_share, BSDF_LEAST_PICK);
    transmitting_share = std::max(transmitting_share, transmission * BSDF_LEAST_PICK);
  }
  const float all = diffuse_share + reflecting_share + transmitting_share;
  if (!(all >= BSDF_LEAST_SHARES)) return;
  pick_diffuse = diffuse_share / all;
  pick_reflecting = reflecting_share / all;
  pick_transmitting = transmitting_share / all;
}

}  // namespace coppice::twins
