#include <algorithm>
#include <limits>

#include "twins/instance.h"

namespace coppice::twins {

void instance_boxes(const InstanceBoxesArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (uint i = 0; i < args.instance_count; ++i) {
    const uint mesh = args.mesh_index[i];
    const Affine transform(args.transforms[i]);
    if (mesh >= args.mesh_count || args.mesh_states[mesh].active_count == 0 || !transform.is_finite()) {
      args.boxes[i] = {vec3(infinity), vec3(-infinity)};
      args.placed[i] = {vec3(0), 0, vec3(0), 0, vec3(0), 0, vec3(0), NO_INSTANCE};
      continue;
    }
    const Node& root = args.mesh_nodes[args.meshes[mesh].first_node];
    const Aabb box{root.box_min, root.box_max};
    args.boxes[i] = transform(box);
    args.placed[i] = place(transform, box, mesh);
    args.mesh_height[0] = std::max(args.mesh_height[0], root.height);
  }
}

}  // namespace coppice::twins
