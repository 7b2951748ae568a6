#include "twins/leave_surface.h"
#include "twins/light_source.h"
#include "twins/material_of.h"

namespace coppice::twins {

void shadow_marks(const ShadowMarksArgs& args) {
  const LightSource& light = args.lights[args.light];
  for (uint i = 0; i < args.ray_count; ++i) {
    args.marks[i] = 0;
    const Hit hit = args.hits[i];
    if (hit.triangle == NO_TRIANGLE) continue;
    const vec3& diffuse = material_of(args, i, hit.triangle).diffuse;
    bool reflects = false;
    for (int channel = 0; channel < 3; ++channel)
      reflects |= diffuse[channel] > 0 && light.radiance[channel] > 0;
    const Triangle& triangle = args.triangles[hit.triangle];
    args.marks[i] = reflects && faces_light(triangle, args.rays[i].direction,
                                            light_direction(light, hit_point(triangle, hit)));
  }
}

}  // namespace coppice::twins
