#include <cmath>
#include <limits>

#include "twins/bsdf.h"
#include "twins/leave_surface.h"
#include "twins/paths.h"
#include "twins/sampler.h"
#include "twins/trace_counts.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

// Russian roulette; 0 where the path ends.
float weight_of_going_on(const PathBounceArgs& args, const Path& path, const vec3& throughput) {
  const float largest = std::fmax(std::fmax(throughput.x, throughput.y), throughput.z);
  if (!(largest > 0)) return 0;
  if (args.bounce < PATH_SURE_BOUNCES) return 1;
  const float chance = std::fmin(largest, PATH_MOST_SURE);
  const float u = sample_1d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_ENDS));
  return u < chance ? 1.0f / chance : 0.0f;
}

uvec2& lobe_counter(PathCounters& counters, uint lobe) {
  if (lobe == BSDF_DIFFUSE) return counters.diffuse;
  return lobe == BSDF_TRANSMISSION ? counters.transmitted : counters.reflected;
}

}  // namespace

void path_bounce(const PathBounceArgs& args) {
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  for (uint i = 0; i < args.ray_count; ++i) {
    args.marks[i] = 0;
    const Hit hit = i < count ? args.hits[i] : Hit{0, NO_TRIANGLE, 0, 0};
    if (hit.triangle == NO_TRIANGLE) continue;
    const Path& path = args.paths[i];
    const vec3& direction = args.rays[i].direction;
    const auto dimension = [&](uint use) { return path_dimension(args.bounce, use); };
    const BsdfSample next =
        bsdf_sample(args.surfaces[i], -unit_vector(direction),
                    sample_1d(path.seed, args.sample_index, dimension(PATH_PICKS_LOBE)),
                    sample_2d(path.seed, args.sample_index, dimension(PATH_TURNS)), switches_of(args.lobes));
    if (next.flags == BSDF_NONE) continue;
    vec3 throughput = path.throughput * next.weight;
    if (next.flags == BSDF_TRANSMISSION)
      throughput *= args.path_materials[args.path_index[hit.triangle]].filter_colour;
    const float weight = weight_of_going_on(args, path, throughput);
    if (weight == 0) continue;
    const Triangle& triangle = args.triangles[hit.triangle];
    const vec3 normal = normal_towards(triangle, direction);
    const bool goes_through = dot_product(normal, next.light) < 0;
    if (goes_through != (next.flags == BSDF_TRANSMISSION)) continue;
    args.marks[i] = 1;
    count_into(lobe_counter(args.counters[0], next.flags), 1);
    args.bounced_paths[i] = {
        throughput * weight, path.pixel, next.pdf, next.flags == BSDF_DIFFUSE ? PATH_SEES_AMBIENT : 0u,
        path.seed,           0};
    args.bounced_rays[i] = {leave_surface(triangle, hit, goes_through ? -normal : normal), 0, next.light,
                            std::numeric_limits<float>::infinity()};
  }
}

}  // namespace coppice::twins
