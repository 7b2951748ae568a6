// In:  a queue of paths and what its rays have hit. Out: surfaces, and radiance of what is emitted; see
// PathSurfacesArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"
#include "lib/scene_light.glsl"
#include "lib/texture_level.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathSurfacesArgs args; };
layout(constant_id = 0) const uint BOUNCES_LIGHT = 1u;
layout(constant_id = 1) const uint HAS_ENVIRONMENT = 1u;

#include "lib/environment.glsl"
#include "lib/material_of.glsl"

// Of a ray that hits nothing.
vec3 surroundings(Path path, vec3 direction) {
  if (HAS_ENVIRONMENT != 0u) {
    float density;
    vec3 radiance = met_environment(args.surroundings, direction, density);
    if (path.pdf == 0.0) return radiance;
    precise float ratio = density / path.pdf;
    precise vec3 own_share = radiance * power_weight(ratio);
    return own_share;
  }
  bool ambient = (path.flags & PATH_SEES_AMBIENT) != 0u;
  return ambient ? args.surroundings.at[0].radiance : sky(direction, args.lighting.at[0]);
}

// That a light sample would have had this direction, by the density that the path's has.
float emission_weight(Path path, Hit hit, Triangle triangle, float cosine) {
  if (uint64_t(args.emitter_probability) == 0ul || path.pdf == 0.0) return 1.0;
  float probability = args.emitter_probability.at[hit.triangle];
  precise float area = 0.5 * twice_area(triangle);
  if (!(probability > 0.0 && area > 0.0 && cosine > 0.0)) return 1.0;
  precise float ratio = probability * (hit.t * hit.t) / (area * cosine) / path.pdf;
  return power_weight(ratio);
}

SurfacePoint surface_point(vec3 base, PathMaterial material, vec3 normal, bool enters) {
  precise vec3 specular = material.specular + (base - material.specular) * material.metallic;
  precise vec3 diffuse = base * (1.0 - material.metallic);
  precise float ratio = enters ? 1.0 / material.ior : material.ior;
  return SurfacePoint(normal, material.roughness, diffuse, ratio, specular, material.transmission);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= counted(args.count_at, args.ray_count)) return;
  Path path = args.paths.at[i];
  Ray ray = load_ray(args.rays, i);
  Hit hit = load_hit(args.hits, i);
  if (hit.triangle == NO_TRIANGLE) {
    add_radiance(args.radiance, path.pixel, path.throughput, surroundings(path, ray.direction));
    return;
  }
  Triangle triangle = args.triangles.at[hit.triangle];
  SurfaceMaterial colours = material_of(i, hit.triangle);
  vec3 normal = normal_of(triangle);
  float cosine = exact_dot(normal, unit(ray.direction));
  bool enters = cosine <= 0.0;
  PathMaterial material = args.path_materials.at[args.path_index.at[hit.triangle]];
  SurfacePoint surface = surface_point(colours.diffuse, material, enters ? normal : -normal, enters);
  precise vec3 seen = colours.ambient * emission_weight(path, hit, triangle, abs(cosine));
  if (BOUNCES_LIGHT == 0u && HAS_ENVIRONMENT == 0u) {
    precise vec3 reflected = surface.diffuse * (1.0 - surface.transmission) * args.surroundings.at[0].radiance;
    seen += reflected;
  }
  add_radiance(args.radiance, path.pixel, path.throughput, seen);
  args.surfaces.at[i] = surface;
}
