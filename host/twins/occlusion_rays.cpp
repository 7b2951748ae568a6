#include "interface/occlusion.h"
#include "twins/cosine_direction.h"
#include "twins/leave_surface.h"
#include "twins/light_source.h"
#include "twins/sampler.h"

namespace coppice::twins {

void occlusion_rays(const OcclusionRaysArgs& args) {
  uint count = 0;
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.marks[i] == 0) continue;
    const Triangle& triangle = args.triangles[args.hits[i].triangle];
    const vec3 normal = camera_side_normal(triangle, args.rays[i].direction);
    const uint pixel = args.pixels.value != 0 ? args.pixels[i] : args.first_ray + i;
    const vec3 away = cosine_direction(normal, sample_2d(pixel, args.sample_index, SAMPLE_OCCLUSION));
    args.occlusion_rays[count++] = {leave_surface(triangle, args.hits[i], normal), 0, away,
                                    args.ambient[0].distance};
  }
  args.ray_counter[0] = count;
}

}  // namespace coppice::twins
