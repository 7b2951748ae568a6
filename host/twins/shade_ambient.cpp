#include "interface/occlusion.h"
#include "twins/material_of.h"

namespace coppice::twins {

void shade_ambient(const ShadeAmbientArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.marks[i] == 0 || args.any_hits[args.places[i]] != 0) continue;
    args.radiance[i] += material_of(args, i, args.hits[i].triangle).diffuse * args.ambient[0].radiance;
  }
}

}  // namespace coppice::twins
