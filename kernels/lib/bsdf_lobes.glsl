// The lobes of lib/bsdf.glsl: their parts of the light, Fresnel's terms, and GGX.
#ifndef COPPICE_LIB_BSDF_LOBES
#define COPPICE_LIB_BSDF_LOBES
#include "lib/exact_vector.glsl"

// What of a surface does not depend on the light.
struct BsdfLobes {
  vec3 normal;
  float cos_view;
  float alpha;          // 0: a mirror, and smooth glass
  float alpha_squared;
  bool reflects;
  bool transmits;
  float ior_ratio;
  float transmission;
  vec3 base;            // reflectance at normal incidence, F0
  vec3 diffuse;         // of the diffuse lobe, 1 - F0 and 1 - transmission multiplied in
  float rise_view;
  vec3 reflectance;     // towards the view, by the normal
  // With which probability each lobe is sampled.
  float pick_diffuse, pick_reflecting, pick_transmitting;
};

float largest_component(vec3 v) { return max(max(v.x, v.y), v.z); }

// The squared cosine of the refracted direction; not positive: total internal reflection. A sum of positive terms
// where the other side is denser.
float bsdf_refracted_square(float cosine, float ior_ratio) {
  precise float along = ior_ratio * cosine;
  precise float square = (1.0 - ior_ratio) * (1.0 + ior_ratio) + along * along;
  return square;
}

// Fresnel's reflectance of a dielectric, of light that is not polarized.
float bsdf_dielectric(float cosine, float ior_ratio) {
  float square = bsdf_refracted_square(cosine, ior_ratio);
  if (square <= 0.0) return 1.0;
  float refracted = sqrt(square);
  precise float across = (ior_ratio * cosine - refracted) / (ior_ratio * cosine + refracted);
  precise float along = (ior_ratio * refracted - cosine) / (ior_ratio * refracted + cosine);
  precise float mean = 0.5 * (across * across + along * along);
  return mean;
}

float bsdf_dielectric_base(float ior_ratio) {
  precise float root = (ior_ratio - 1.0) / (ior_ratio + 1.0);
  precise float square = root * root;
  return square;
}

// How far reflectance has risen from F0, 0, to 1, as light comes flatter: F = F0 + (1 - F0) rise.
float bsdf_rise(BsdfLobes lobes, float cosine) {
  if (!lobes.reflects) return 0.0;
  if (lobes.transmits) {
    float base = lobes.base.x;
    precise float rise = (bsdf_dielectric(max(cosine, 0.0), lobes.ior_ratio) - base) / (1.0 - base);
    return min(max(rise, 0.0), 1.0);
  }
  float flat_part = 1.0 - min(max(cosine, 0.0), 1.0);
  precise float square = flat_part * flat_part;
  precise float fifth = square * square * flat_part;
  return fifth;
}

vec3 bsdf_reflectance(BsdfLobes lobes, float cosine) {
  precise vec3 reflectance = lobes.base + (1.0 - lobes.base) * bsdf_rise(lobes, cosine);
  return reflectance;
}

// GGX, of a unit facet, by solid angle. The sine comes from a cross product: 1 less the squared cosine has no digits
// where alpha is small.
float bsdf_facet_density(BsdfLobes lobes, vec3 facet) {
  vec3 beside = exact_cross(lobes.normal, facet);
  float cosine = exact_dot(lobes.normal, facet);
  precise float spread = exact_dot(beside, beside) + lobes.alpha_squared * (cosine * cosine);
  precise float at_least = max(spread, lobes.alpha_squared);
  precise float density = lobes.alpha_squared * ONE_BY_PI / (at_least * at_least);
  return density;
}

// cosine * sqrt(1 + alpha^2 tan^2), of Smith's masking 2 cosine / (cosine + slope).
float bsdf_slope(BsdfLobes lobes, float cosine) {
  precise float square = lobes.alpha_squared + (1.0 - lobes.alpha_squared) * (cosine * cosine);
  return sqrt(max(square, 0.0));
}

// In proportion to what lobes reflect and transmit towards the view; a rough lobe, whose facets may do much more of it
// than its mean plane, has no less than a part.
void bsdf_pick(inout BsdfLobes lobes) {
  bool rough = lobes.alpha > 0.0;
  precise float diffuse = largest_component(lobes.diffuse) * (1.0 - lobes.rise_view);
  if (BSDF_DIFFUSE_LOBE == 0u) diffuse = 0.0;
  float reflecting = lobes.reflects ? largest_component(lobes.reflectance) : 0.0;
  if (lobes.reflects && rough) reflecting = max(reflecting, BSDF_LEAST_PICK);
  precise float transmitting = lobes.transmission * ((1.0 - lobes.base.x) * (1.0 - lobes.rise_view));
  precise float transmitting_least = lobes.transmission * BSDF_LEAST_PICK;
  if (rough) transmitting = max(transmitting, transmitting_least);
  precise float shares = diffuse + reflecting + transmitting;
  bool dark = !(shares >= BSDF_LEAST_SHARES);
  precise vec3 picks = vec3(diffuse, reflecting, transmitting) / (dark ? 1.0 : shares);
  lobes.pick_diffuse = dark ? 0.0 : picks.x;
  lobes.pick_reflecting = dark ? 0.0 : picks.y;
  lobes.pick_transmitting = dark ? 0.0 : picks.z;
}

BsdfLobes bsdf_lobes(SurfacePoint s, vec3 view) {
  BsdfLobes lobes;
  lobes.normal = s.normal;
  lobes.cos_view = exact_dot(s.normal, view);
  float roughness = min(max(s.roughness, 0.0), 1.0);
  precise float alpha = roughness * roughness;
  lobes.alpha = alpha < BSDF_MIRROR_ALPHA ? 0.0 : alpha;
  precise float alpha_squared = lobes.alpha * lobes.alpha;
  lobes.alpha_squared = alpha_squared;
  lobes.ior_ratio = min(max(s.ior_ratio, 0.0625), 16.0);
  lobes.transmission = BSDF_TRANSMITS != 0u ? min(max(s.transmission, 0.0), 1.0) : 0.0;
  lobes.transmits = BSDF_TRANSMITS != 0u && lobes.transmission > 0.0;
  vec3 specular = min(max(s.specular, vec3(0.0)), vec3(1.0));
  bool boundary = !lobes.transmits || lobes.ior_ratio != 1.0;
  lobes.reflects = BSDF_REFLECTS != 0u && boundary && largest_component(specular) > 0.0;
  lobes.base = vec3(0.0);
  if (lobes.reflects) lobes.base = lobes.transmits ? vec3(bsdf_dielectric_base(lobes.ior_ratio)) : specular;
  precise vec3 diffuse = min(max(s.diffuse, vec3(0.0)), vec3(1.0)) * (1.0 - lobes.transmission) * (1.0 - lobes.base);
  lobes.diffuse = diffuse;
  lobes.rise_view = bsdf_rise(lobes, lobes.cos_view);
  lobes.reflectance = bsdf_reflectance(lobes, lobes.cos_view);
  bsdf_pick(lobes);
  return lobes;
}

#endif
