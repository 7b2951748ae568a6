#include <cmath>

#include "twins/bsdf.h"
#include "twins/fog.h"
#include "twins/leave_surface.h"
#include "twins/light_sample.h"
#include "twins/paths.h"
#include "twins/sampler.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

vec3 reflected_towards(const SurfacePoint& surface, const vec3& view, const SampledLight& light, uint lobes) {
  const BsdfSwitches switches = switches_of(lobes);
  const BsdfTerms terms = bsdf_terms(surface, view, unit_vector(light.towards), switches);
  const vec3 all = terms.diffuse + terms.glossy;
  if (light.pdf == 0 || (lobes & PATH_LAST_BOUNCE) != 0) return all;
  const vec3 both = bsdf_sampled(terms, switches);
  return (all - both) + both * power_weight(terms.pdf / light.pdf);
}

}  // namespace

void path_lights(const PathLightsArgs& args) {
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  for (uint i = 0; i < args.ray_count; ++i) {
    args.marks[i] = 0;
    if (i >= count || args.hits[i].triangle == NO_TRIANGLE) continue;
    const Path& path = args.paths[i];
    const vec3& direction = args.rays[i].direction;
    const Triangle& triangle = args.triangles[args.hits[i].triangle];
    const vec3 origin = leave_surface(triangle, args.hits[i], normal_towards(triangle, direction));
    const LightTables tables = light_tables(args);
    const LightChoice& choice = choice_for(
        tables, sample_1d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PICKS_LIGHT)));
    const auto light =
        sample_choice(tables, choice, origin,
                      sample_2d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_PLACES_LIGHT)),
                      sample_2d(path.seed, args.sample_index, PATH_PLACES_IN_TEXEL + args.bounce));
    if (!light) continue;
    vec3 colour =
        reflected_towards(args.surfaces[i], -unit_vector(direction), *light, args.lobes) * light->radiance;
    if (args.has_fog != 0)
      colour *= transmittance_of(fog_of(args.surroundings), {origin, 0, light->towards, light->t_max});
    if (!(std::fmax(std::fmax(colour.x, colour.y), colour.z) > 0)) continue;
    if (choice.shadows == 0) {
      args.radiance[path.pixel] += path.throughput * colour;
      continue;
    }
    args.marks[i] = 1;
    args.light_radiance[i] = path.throughput * colour;
    args.light_rays[i] = {origin, 0, light->towards, light->t_max};
  }
}

}  // namespace coppice::twins
