#include "twins/paths.h"

namespace coppice::twins {

void path_light_add(const PathLightAddArgs& args) {
  const uint count = paths_in_queue(args.count_at, args.ray_count);
  for (uint i = 0; i < count; ++i) {
    if (args.marks[i] != 0 && args.any_hits[args.places[i]] == 0)
      args.radiance[args.paths[i].pixel] += args.light_radiance[i];
  }
}

}  // namespace coppice::twins
