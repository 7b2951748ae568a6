#include <cmath>

#include "twins/environment.h"
#include "twins/material_of.h"
#include "twins/paths.h"
#include "twins/shading.h"
#include "twins/texture.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

// Of emission that a sampled light could have found as well.
float share_of_path(const PathSurfacesArgs& args, const Path& path, const Hit& hit, float cosine) {
  if (args.emitter_probability.value == 0 || path.pdf == 0) return 1;
  const float probability = args.emitter_probability[hit.triangle];
  const float area = 0.5f * twice_area(args.triangles[hit.triangle]);
  if (!(probability > 0) || !(area > 0) || !(cosine > 0)) return 1;
  return power_weight(probability * (hit.t * hit.t) / (area * cosine) / path.pdf);
}

// Of the environment, likewise.
vec3 environment_met(const PathSurfacesArgs& args, const Path& path, const vec3& direction) {
  const EnvironmentLight met = environment_in(args.surroundings, direction);
  return path.pdf == 0 ? met.radiance : met.radiance * power_weight(met.density / path.pdf);
}

}  // namespace

void path_surfaces(const PathSurfacesArgs& args) {
  const bool bounces_light = (args.flags & PATH_BOUNCES_LIGHT) != 0;
  const bool has_environment = (args.flags & PATH_HAS_ENVIRONMENT) != 0;
  const vec3 ambient_light = args.surroundings[0].radiance;
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  for (uint i = 0; i < count; ++i) {
    const Path& path = args.paths[i];
    const Hit hit = args.hits[i];
    const vec3& direction = args.rays[i].direction;
    vec3& radiance = args.radiance[path.pixel];
    if (hit.triangle == NO_TRIANGLE) {
      const bool ambient = (path.flags & PATH_SEES_AMBIENT) != 0;
      radiance += path.throughput * (has_environment ? environment_met(args, path, direction)
                                     : ambient       ? ambient_light
                                                     : sky_colour(direction, args.lighting[0]));
      continue;
    }
    const vec3 normal = unit_normal(args.triangles[hit.triangle]);
    const float cosine = dot_product(normal, unit_vector(direction));
    const PathMaterial& material = args.path_materials[args.path_index[hit.triangle]];
    const SurfaceMaterial& colours = material_of(args, i, hit.triangle);
    const vec3 base = colours.diffuse;
    SurfacePoint& surface = args.surfaces[i];
    surface.normal = cosine > 0 ? -normal : normal;
    surface.roughness = material.roughness;
    surface.diffuse = base * (1.0f - material.metallic);
    surface.ior_ratio = cosine > 0 ? material.ior : 1.0f / material.ior;
    surface.specular = material.specular + (base - material.specular) * material.metallic;
    surface.transmission = material.transmission;
    vec3 seen = colours.ambient * share_of_path(args, path, hit, std::fabs(cosine));
    if (!bounces_light && !has_environment)
      seen += surface.diffuse * (1.0f - material.transmission) * ambient_light;
    radiance += path.throughput * seen;
  }
}

}  // namespace coppice::twins
