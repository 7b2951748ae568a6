#include "interface/paths.h"
#include "stages/stages.h"
#include "stages/traffic_shares.h"

namespace coppice::traffic {

namespace {

// Of paths that go on the part of a step over `rays` rays of the picture.
Bytes path_share(Bytes sum, Bytes rays, const RunCounts& counts) {
  const Bytes all = counts.paths.could_be + counts.rays;
  if (all == 0) return 0;
  return static_cast<Bytes>(static_cast<double>(sum) * static_cast<double>(rays) / static_cast<double>(all));
}

Bytes queued(const RunCounts& counts) { return counts.rays + counts.paths.rays; }
Bytes met(const RunCounts& counts) { return counts.hits + counts.paths.hits; }

}  // namespace

Bytes path_start(const PathStartArgs& a, const RunCounts&) {
  return Bytes{a.ray_count} * (sizeof(Path) + (a.sample_index == 0 ? sizeof(vec3) : 0));
}

// Of each path its ray and its hit. How many go through the fog, nobody counts.
Bytes path_fog(const PathFogArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 +
         path_share(queued(counts), a.ray_count, counts) * (sizeof(Hit) + 2 * sizeof(vec3));
}

// Of each path its ray, its hit and its radiance, of a hit its surface; of a miss that meets an environment
// four texels, the two ends of a share and its row.
Bytes path_surfaces(const PathSurfacesArgs& a, const RunCounts& counts) {
  const bool environment = (a.flags & PATH_HAS_ENVIRONMENT) != 0;
  return path_share(queued(counts), a.ray_count, counts) *
             (sizeof(Path) + sizeof(vec3) + sizeof(Hit) + 2 * sizeof(vec3)) +
         path_share(met(counts), a.ray_count, counts) *
             (sizeof(Triangle) + 8 + sizeof(SurfaceMaterial) + sizeof(PathMaterial) + sizeof(SurfacePoint)) +
         path_share(environment ? queued(counts) - met(counts) : 0, a.ray_count, counts) * 7 *
             sizeof(Surrounding);
}

// Of each ray its mark, of a hit its surface and a light.
Bytes path_lights(const PathLightsArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 + path_share(queued(counts), a.ray_count, counts) * sizeof(Hit) +
         path_share(met(counts), a.ray_count, counts) * (sizeof(Path) + sizeof(vec3) + 2 * sizeof(Triangle) +
                                                         sizeof(SurfacePoint) + sizeof(LightChoice)) +
         shadow_share(counts.shadow.rays, a.ray_count, counts) * (sizeof(Ray) + sizeof(vec3));
}

Bytes path_light_add(const PathLightAddArgs& a, const RunCounts& counts) {
  return path_share(queued(counts), a.ray_count, counts) * 4 +
         shadow_share(counts.shadow.rays, a.ray_count, counts) * 8 +
         shadow_share(counts.shadow.rays - counts.shadow.hits, a.ray_count, counts) * (4 + 3 * sizeof(vec3));
}

Bytes path_bounce(const PathBounceArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 + path_share(queued(counts), a.ray_count, counts) * sizeof(Hit) +
         path_share(met(counts), a.ray_count, counts) *
             (sizeof(Path) + sizeof(vec3) + sizeof(Triangle) + sizeof(SurfacePoint)) +
         path_share(counts.paths.rays, a.ray_count, counts) * (sizeof(Ray) + sizeof(Path));
}

Bytes path_queue(const PathQueueArgs& a, const RunCounts& counts) {
  const bool paths = a.marked_paths.value != 0;
  return Bytes{a.ray_count} * 8 + (paths ? path_share(counts.paths.rays, a.ray_count, counts)
                                         : shadow_share(counts.shadow.rays, a.ray_count, counts)) *
                                      (2 * sizeof(Ray) + (paths ? 2 * sizeof(Path) + sizeof(Hit) : 0));
}

}  // namespace coppice::traffic
