#include "interface/occlusion.h"
#include "twins/material_of.h"

namespace coppice::twins {

void occlusion_marks(const OcclusionMarksArgs& args) {
  const vec3& light = args.ambient[0].radiance;
  for (uint i = 0; i < args.ray_count; ++i) {
    bool reflects = false;
    if (const uint triangle = args.hits[i].triangle; triangle != NO_TRIANGLE) {
      const vec3& diffuse = material_of(args, i, triangle).diffuse;
      for (int channel = 0; channel < 3; ++channel) reflects |= diffuse[channel] > 0 && light[channel] > 0;
    }
    args.marks[i] = reflects;
  }
}

}  // namespace coppice::twins
