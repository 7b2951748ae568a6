#include <cmath>
#include <limits>

#include "twins/exponential.h"
#include "twins/fog.h"
#include "twins/light_sample.h"
#include "twins/paths.h"
#include "twins/sampler.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

bool is_dark(const vec3& colour) { return !(std::fmax(std::fmax(colour.x, colour.y), colour.z) > 0); }

// A light for a point of the way of ray i. `scattered`: the part of throughput that is.
void scatter(const PathFogArgs& args, uint i, const Fog& fog, const FogReach& reach, float depth,
             const vec3& scattered) {
  const Ray& ray = args.rays[i];
  const Path& path = args.paths[i];
  const auto dimension = [&](uint use) { return PATH_FOG_FIRST + args.bounce * PATH_FOG_DIMENSIONS + use; };
  const float u = sample_1d(path.seed, args.sample_index, dimension(PATH_FOG_DEPTH));
  const float part = std::fmin(minus_log(1 - u * one_minus_exp(depth)) / depth, 1.0f);
  const float t = reach.enters + part * (reach.leaves - reach.enters);
  const vec3 place = ray.origin + ray.direction * t;
  const LightTables tables = light_tables(args);
  const LightChoice& choice =
      choice_for(tables, sample_1d(path.seed, args.sample_index, dimension(PATH_FOG_PICKS_LIGHT)));
  const auto light = sample_choice(
      tables, choice, place, sample_2d(path.seed, args.sample_index, dimension(PATH_FOG_PLACES_LIGHT)),
      sample_2d(path.seed, args.sample_index, dimension(PATH_FOG_PLACES_IN_TEXEL)));
  if (!light) return;
  const Ray light_ray{place, 0, light->towards, light->t_max};
  const float cosine = dot_product(unit_vector(ray.direction), unit_vector(light->towards));
  const vec3 colour = light->radiance * (phase_of(fog.anisotropy, cosine) * transmittance_of(fog, light_ray));
  if (is_dark(colour)) return;
  if (choice.shadows == 0) {
    args.radiance[path.pixel] += scattered * colour;
    return;
  }
  args.marks[i] = 1;
  args.light_radiance[i] = scattered * colour;
  args.light_rays[i] = light_ray;
}

}  // namespace

void path_fog(const PathFogArgs& args) {
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  const Fog fog = fog_of(args.surroundings);
  for (uint i = 0; i < args.ray_count; ++i) {
    args.marks[i] = 0;
    if (i >= count) continue;
    Ray seen = args.rays[i];
    seen.t_max =
        args.hits[i].triangle == NO_TRIANGLE ? std::numeric_limits<float>::infinity() : args.hits[i].t;
    const FogReach reach = reach_of_fog(fog, seen);
    const float depth = optical_depth(fog, seen.direction, reach);
    if (!(depth > 0)) continue;
    Path& path = args.paths[i];
    const vec3 scattered = path.throughput * fog.albedo * one_minus_exp(depth);
    path.throughput = path.throughput * exp_minus(depth);
    if (is_dark(scattered)) continue;
    if (args.bounces_light == 0) args.radiance[path.pixel] += scattered * args.surroundings[0].radiance;
    if (args.choice_count > 0) scatter(args, i, fog, reach, depth, scattered);
  }
}

}  // namespace coppice::twins
