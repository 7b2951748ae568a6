// What a surface reflects and transmits: a diffuse lobe (Lambert), a reflecting one (a mirror, or GGX: Walter et al.
// 2007, "Microfacet Models for Refraction through Rough Surfaces", with the height-correlated masking of Heitz 2014,
// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2)), and the transmission of a
// dielectric, through facets where it is rough. Visible facets are sampled by spherical caps: Dupuy and Benyoub 2023,
// "Sampling Visible GGX Normals with Spherical Caps". `view` and `light` are unit and point away from the surface.
//
// Fresnel reflectance F is Schlick's (1994) of `specular`; the exact one of ior_ratio, and grey, where the surface
// transmits and `specular` is not black. The diffuse lobe gets (1 - F(view)) (1 - F(light)) / (1 - F0) of the light,
// which is symmetric, and with what is reflected no more than all of it. A dielectric without reflecting lobe transmits
// all, and reflects where reflection is total; one of ratio 1 is no boundary, and lets pass straight what it transmits.
//
// Transmission scales no radiance: weights are those of radiance divided by the squared index of refraction. Where
// camera and lights are in the same medium it is the same; the radiance of a light inside of glass is to be divided.
//
// Mirrors and transmission, rough or not, have no density: BsdfTerms is without them, and their samples have pdf 0, so
// that what they meet counts in full. Else with two ways to a light the weight of a sampled light is on what both can
// meet: bsdf_sampled. Where BSDF_DIFFUSE_LOBE is 0 paths do not go on by the diffuse lobe, so it counts in full.
//
// The including kernel has the constants BSDF_DIFFUSE_LOBE, BSDF_REFLECTS and BSDF_TRANSMITS, uint, 0 or 1.
#ifndef COPPICE_LIB_BSDF
#define COPPICE_LIB_BSDF
#include "interface/paths.h"
#include "lib/bsdf_lobes.glsl"
#include "lib/bsdf_directions.glsl"

BsdfTerms bsdf_terms_of(BsdfLobes lobes, vec3 view, vec3 light) {
  BsdfTerms terms = BsdfTerms(vec3(0.0), 0.0, vec3(0.0), 0.0);
  float cos_view = lobes.cos_view, cos_light = exact_dot(lobes.normal, light);
  if (!(cos_view >= BSDF_MIN_COSINE && cos_light >= BSDF_MIN_COSINE)) return terms;
  precise float lambert = cos_light * ONE_BY_PI;
  precise float entering = (1.0 - lobes.rise_view) * (1.0 - bsdf_rise(lobes, cos_light)) * lambert;
  precise vec3 diffuse = lobes.diffuse * entering;
  precise float pdf = lobes.pick_diffuse * lambert;
  terms.diffuse = diffuse;
  terms.pdf = pdf;
  if (!lobes.reflects || lobes.alpha == 0.0) return terms;
  vec3 sum = view + light;
  vec3 facet = unit(sum);
  float density = bsdf_facet_density(lobes, facet);
  float slope_view = bsdf_slope(lobes, cos_view), slope_light = bsdf_slope(lobes, cos_light);
  precise float masked = 0.5 * density * cos_light / (cos_light * slope_view + cos_view * slope_light);
  precise vec3 glossy = bsdf_reflectance(lobes, exact_dot(view, facet)) * masked;
  precise float both = pdf + lobes.pick_reflecting * (0.5 * density / (cos_view + slope_view));
  terms.glossy = glossy;
  terms.pdf = both;
  return terms;
}

BsdfTerms bsdf_terms(SurfacePoint s, vec3 view, vec3 light) {
  return bsdf_terms_of(bsdf_lobes(s, view), view, light);
}

// Of the terms, what bsdf_sample samples by their pdf.
vec3 bsdf_sampled(BsdfTerms terms) {
  if (BSDF_DIFFUSE_LOBE == 0u) return terms.glossy;
  precise vec3 both = terms.diffuse + terms.glossy;
  return both;
}

// BSDF times cosine, of all lobes that have a density.
vec3 bsdf_value(SurfacePoint s, vec3 view, vec3 light) {
  BsdfTerms terms = bsdf_terms(s, view, light);
  precise vec3 both = terms.diffuse + terms.glossy;
  return both;
}

float bsdf_pdf(SurfacePoint s, vec3 view, vec3 light) { return bsdf_terms(s, view, light).pdf; }

const BsdfSample BSDF_NO_SAMPLE = BsdfSample(vec3(0.0), 0.0, vec3(0.0), BSDF_NONE);

// Both lobes that have a density, by a direction of one of them.
BsdfSample bsdf_sample_terms(BsdfLobes lobes, vec3 view, vec3 light, uint flags) {
  BsdfTerms terms = bsdf_terms_of(lobes, view, light);
  if (!(terms.pdf > 0.0)) return BSDF_NO_SAMPLE;
  precise vec3 weight = bsdf_sampled(terms) / terms.pdf;
  return BsdfSample(light, terms.pdf, weight, flags);
}

BsdfSample bsdf_sample_mirror(BsdfLobes lobes, vec3 view) {
  precise vec3 weight = lobes.reflectance / lobes.pick_reflecting;
  return BsdfSample(bsdf_mirrored(view, lobes.normal, lobes.cos_view), 0.0, weight, BSDF_MIRROR);
}

// Refracted by a facet, or reflected where reflection is total.
BsdfSample bsdf_sample_transmission(BsdfLobes lobes, vec3 view, vec2 u) {
  bool rough = lobes.alpha > 0.0 && lobes.ior_ratio != 1.0;
  vec3 facet = lobes.normal;
  if (rough) facet = bsdf_visible_facet(lobes.normal, view, lobes.alpha, u);
  float cos_facet = exact_dot(view, facet);
  if (!(cos_facet >= BSDF_MIN_COSINE)) return BSDF_NO_SAMPLE;
  float square = bsdf_refracted_square(cos_facet, lobes.ior_ratio);
  bool total = square <= 0.0;
  vec3 light = total ? bsdf_mirrored(view, facet, cos_facet)
                     : bsdf_refracted(view, facet, cos_facet, sqrt(max(square, 0.0)), lobes.ior_ratio);
  float side = exact_dot(lobes.normal, light);
  side = total ? side : -side;
  precise float through = lobes.transmission * ((1.0 - lobes.base.x) * (1.0 - bsdf_rise(lobes, cos_facet)));
  if (!(side >= BSDF_MIN_COSINE && through > 0.0)) return BSDF_NO_SAMPLE;
  precise float masked = 2.0 * side / (side + bsdf_slope(lobes, side));
  precise float weight = (rough ? through * masked : through) / lobes.pick_transmitting;
  return BsdfSample(light, 0.0, vec3(weight), total ? BSDF_MIRROR : BSDF_TRANSMISSION);
}

// `lobe` and u: in [0, 1), independent.
BsdfSample bsdf_sample(SurfacePoint s, vec3 view, float lobe, vec2 u) {
  BsdfLobes lobes = bsdf_lobes(s, view);
  precise float not_transmitting = lobes.pick_diffuse + lobes.pick_reflecting;
  bool none = !(lobes.cos_view >= BSDF_MIN_COSINE) ||
              !(lobes.pick_diffuse > 0.0 || lobes.pick_reflecting > 0.0 || lobes.pick_transmitting > 0.0);
  if (none) return BSDF_NO_SAMPLE;
  if (BSDF_TRANSMITS != 0u && lobes.pick_transmitting > 0.0 && lobe >= not_transmitting)
    return bsdf_sample_transmission(lobes, view, u);
  bool diffuse = lobe < lobes.pick_diffuse || !(lobes.pick_reflecting > 0.0);
  if (BSDF_REFLECTS != 0u && !diffuse && lobes.alpha == 0.0) return bsdf_sample_mirror(lobes, view);
  vec3 light = vec3(0.0);
  if (BSDF_DIFFUSE_LOBE != 0u && diffuse) light = bsdf_diffuse_direction(lobes.normal, u);
  if (BSDF_REFLECTS != 0u && !diffuse) {
    vec3 facet = bsdf_visible_facet(lobes.normal, view, lobes.alpha, u);
    light = bsdf_mirrored(view, facet, exact_dot(view, facet));
  }
  return bsdf_sample_terms(lobes, view, light, diffuse ? BSDF_DIFFUSE : BSDF_GLOSSY);
}

#endif
