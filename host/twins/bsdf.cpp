#include "twins/bsdf.h"

#include <algorithm>
#include <cmath>

#include "twins/bsdf_lobes.h"
#include "twins/circle.h"
#include "twins/cosine_direction.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

const BsdfSample no_direction = {vec3(0), 0, vec3(0), BSDF_NONE};

// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
vec3 visible_facet(const vec3& normal, const vec3& view, float alpha, const glm::vec2& u) {
  const TangentFrame frame(normal);
  const vec3 from = unit_vector({alpha * dot_product(frame.tangent, view),
                                 alpha * dot_product(frame.bitangent, view), dot_product(normal, view)});
  const float fall = u.y * (1 + from.z);  // of the point of the cap, from the pole
  const float radius = std::sqrt(std::max(fall * (2 - fall), 0.0f));
  const OnCircle at = circle_at(u.x);
  return frame.to_world(alpha * (radius * at.cos + from.x), alpha * (radius * at.sin + from.y),
                        (1 - u.y) * (1 + from.z));
}

vec3 mirror_direction(const vec3& view, const vec3& normal, float cosine) {
  return unit_vector(normal * (2 * cosine) - view);
}

vec3 refracted_direction(const vec3& view, const vec3& normal, float cosine, float ior_ratio, float square) {
  if (ior_ratio == 1) return -view;
  return unit_vector(normal * (ior_ratio * cosine - std::sqrt(square)) - view * ior_ratio);
}

BsdfTerms terms_of(const BsdfLobes& lobes, const vec3& view, const vec3& light) {
  const float cos_view = lobes.cos_view, cos_light = dot_product(lobes.normal, light);
  if (!lobes.seen() || !(cos_light >= BSDF_MIN_COSINE)) return {vec3(0), 0, vec3(0), 0};
  const float lambert = cos_light * ONE_BY_PI;
  const float inwards = (1 - lobes.rise_to_view) * (1 - lobes.rise(cos_light));
  BsdfTerms terms = {lobes.diffuse * (inwards * lambert), lobes.pick_diffuse * lambert, vec3(0), 0};
  if (lobes.reflects && !lobes.is_smooth()) {
    const vec3 facet = unit_vector(view + light);
    const float density = lobes.facet_density(facet);
    const float slope_view = lobes.slope(cos_view), slope_light = lobes.slope(cos_light);
    const float lit = 0.5f * density * cos_light / (cos_light * slope_view + cos_view * slope_light);
    terms.glossy = lobes.reflectance(dot_product(view, facet)) * lit;
    terms.pdf += lobes.pick_reflecting * (0.5f * density / (cos_view + slope_view));
  }
  return terms;
}

BsdfSample sample_transmission(const BsdfLobes& lobes, const vec3& view, const glm::vec2& u) {
  const bool rough = !lobes.is_smooth() && lobes.ior_ratio != 1;
  const vec3 facet = rough ? visible_facet(lobes.normal, view, lobes.alpha, u) : lobes.normal;
  const float cosine = dot_product(view, facet);
  if (!(cosine >= BSDF_MIN_COSINE)) return no_direction;
  const float square = refracted_cosine_square(cosine, lobes.ior_ratio);
  const bool total = square <= 0;
  const vec3 light = total ? mirror_direction(view, facet, cosine)
                           : refracted_direction(view, facet, cosine, lobes.ior_ratio, square);
  const float height = dot_product(lobes.normal, light) * (total ? 1.0f : -1.0f);
  float through = lobes.transmission * ((1 - lobes.at_normal.x) * (1 - lobes.rise(cosine)));
  if (!(height >= BSDF_MIN_COSINE) || !(through > 0)) return no_direction;
  if (rough) through *= 2 * height / (height + lobes.slope(height));
  const vec3 weight(through / lobes.pick_transmitting);
  return {light, 0, weight, total ? BSDF_MIRROR : BSDF_TRANSMISSION};
}

}  // namespace

BsdfTerms bsdf_terms(const SurfacePoint& surface, const vec3& view, const vec3& light,
                     const BsdfSwitches& switches) {
  return terms_of(BsdfLobes(surface, view, switches), view, light);
}

vec3 bsdf_sampled(const BsdfTerms& terms, const BsdfSwitches& switches) {
  return switches.diffuse_lobe ? terms.diffuse + terms.glossy : terms.glossy;
}

vec3 bsdf_value(const SurfacePoint& surface, const vec3& view, const vec3& light,
                const BsdfSwitches& switches) {
  const BsdfTerms terms = bsdf_terms(surface, view, light, switches);
  return terms.diffuse + terms.glossy;
}

float bsdf_pdf(const SurfacePoint& surface, const vec3& view, const vec3& light,
               const BsdfSwitches& switches) {
  return bsdf_terms(surface, view, light, switches).pdf;
}

BsdfSample bsdf_sample(const SurfacePoint& surface, const vec3& view, float lobe, const glm::vec2& u,
                       const BsdfSwitches& switches) {
  const BsdfLobes lobes(surface, view, switches);
  const bool any = lobes.pick_diffuse > 0 || lobes.pick_reflecting > 0 || lobes.pick_transmitting > 0;
  if (!lobes.seen() || !any) return no_direction;
  if (lobes.pick_transmitting > 0 && lobe >= lobes.pick_diffuse + lobes.pick_reflecting)
    return sample_transmission(lobes, view, u);
  const bool diffuse = lobe < lobes.pick_diffuse || !(lobes.pick_reflecting > 0);
  vec3 light;
  if (diffuse) {
    light = cosine_direction(lobes.normal, u);
  } else if (lobes.is_smooth()) {
    light = mirror_direction(view, lobes.normal, lobes.cos_view);
    return {light, 0, lobes.to_view / lobes.pick_reflecting, BSDF_MIRROR};
  } else {
    const vec3 facet = visible_facet(lobes.normal, view, lobes.alpha, u);
    light = mirror_direction(view, facet, dot_product(view, facet));
  }
  const BsdfTerms terms = terms_of(lobes, view, light);
  if (!(terms.pdf > 0)) return no_direction;
  return {light, terms.pdf, bsdf_sampled(terms, switches) / terms.pdf, diffuse ? BSDF_DIFFUSE : BSDF_GLOSSY};
}

}  // namespace coppice::twins
