// In:  a queue of paths, their surfaces. Out: the rays by which they go on, see PathBounceArgs. Russian roulette after
// the first bounces: Arvo and Kirk 1990, "Particle Transport and Image Synthesis".
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"
#include "lib/offset_origin.glsl"
#include "lib/sampler.glsl"
#include "lib/subgroup.glsl"
#include "lib/trace_counters.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathBounceArgs args; };
layout(constant_id = 0) const uint BSDF_DIFFUSE_LOBE = 1u;
layout(constant_id = 1) const uint BSDF_REFLECTS = 1u;
layout(constant_id = 2) const uint BSDF_TRANSMITS = 1u;

#include "lib/bsdf.glsl"

float random_of(Path path, uint use) {
  return sample_1d(path.seed, args.sample_index, path_dimension(args.bounce, use));
}

// 1 divided by the chance that a path goes on; 0 where it ends.
float survival(Path path, vec3 throughput) {
  float largest = max(max(throughput.x, throughput.y), throughput.z);
  if (!(largest > 0.0)) return 0.0;
  if (args.bounce < PATH_SURE_BOUNCES) return 1.0;
  float chance = min(largest, PATH_MOST_SURE);
  if (!(random_of(path, PATH_ENDS) < chance)) return 0.0;
  precise float result = 1.0 / chance;
  return result;
}

// Stores the next ray of path i, and returns of which lobe it is: BSDF_, none where the path ends.
uint go_on(uint i) {
  Hit hit = load_hit(args.hits, i);
  if (hit.triangle == NO_TRIANGLE) return BSDF_NONE;
  Path path = args.paths.at[i];
  vec3 direction = args.rays.at[i].direction;
  vec2 u = sample_2d(path.seed, args.sample_index, path_dimension(args.bounce, PATH_TURNS));
  BsdfSample next = bsdf_sample(args.surfaces.at[i], -unit(direction), random_of(path, PATH_PICKS_LOBE), u);
  if (next.flags == BSDF_NONE) return BSDF_NONE;
  precise vec3 throughput = path.throughput * next.weight;
  if (next.flags == BSDF_TRANSMISSION) {
    precise vec3 filtered = throughput * args.path_materials.at[args.path_index.at[hit.triangle]].filter_colour;
    throughput = filtered;
  }
  float more = survival(path, throughput);
  if (more == 0.0) return BSDF_NONE;
  precise vec3 carried = throughput * more;
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 normal = normal_towards(triangle, direction);
  bool goes_through = exact_dot(normal, next.light) < 0.0;
  if (goes_through != (next.flags == BSDF_TRANSMISSION)) return BSDF_NONE;
  vec3 origin = offset_origin(triangle, hit.u, hit.v, goes_through ? -normal : normal);
  uint flags = next.flags == BSDF_DIFFUSE ? PATH_SEES_AMBIENT : 0u;
  args.bounced_paths.at[i] = Path(carried, path.pixel, next.pdf, flags, path.seed, 0u);
  store_ray(args.bounced_rays, i, Ray(origin, 0.0, next.light, uintBitsToFloat(0x7f800000u)));
  return next.flags;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint lobe = i < counted(args.count_at, args.ray_count) ? go_on(i) : BSDF_NONE;
  if (i < args.ray_count) args.marks.at[i] = lobe == BSDF_NONE ? 0u : 1u;
  COUNT_INTO(args.counters.at[0].diffuse, lobe == BSDF_DIFFUSE ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].reflected, (lobe & (BSDF_GLOSSY | BSDF_MIRROR)) != 0u ? 1u : 0u)
  COUNT_INTO(args.counters.at[0].transmitted, lobe == BSDF_TRANSMISSION ? 1u : 0u)
}
