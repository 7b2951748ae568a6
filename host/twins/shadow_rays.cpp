#include <limits>

#include "twins/leave_surface.h"
#include "twins/light_source.h"

namespace coppice::twins {

void shadow_rays(const ShadowRaysArgs& args) {
  const LightSource& light = args.lights[args.light];
  const float end = light.kind == LIGHT_POINT ? 1.0f : std::numeric_limits<float>::infinity();
  uint count = 0;
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.marks[i] == 0) continue;
    const Triangle& triangle = args.triangles[args.hits[i].triangle];
    const vec3 origin =
        leave_surface(triangle, args.hits[i], camera_side_normal(triangle, args.rays[i].direction));
    args.shadow_rays[count++] = {origin, 0, light_direction(light, origin), end};
  }
  args.shadow_count[0] = count;
}

}  // namespace coppice::twins
