#include <algorithm>
#include <limits>

#include "twins/instance.h"

namespace coppice::twins {

namespace {

// Its tree's root; null for an instance that is inactive.
const Node* root_of(const InstanceBoxesArgs& args, uint instance) {
  const uint mesh = args.mesh_index[instance];
  if (mesh >= args.mesh_count || args.mesh_states[mesh].active_count == 0) return nullptr;
  const Node& root = args.mesh_nodes[args.meshes[mesh].first_node];
  const bool refitted_to_nothing = root.box_min.x > root.box_max.x;
  return refitted_to_nothing ? nullptr : &root;
}

}  // namespace

void instance_boxes(const InstanceBoxesArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (uint i = 0; i < args.instance_count; ++i) {
    const Affine transform(args.transforms[i]);
    const Node* const root = transform.is_finite() ? root_of(args, i) : nullptr;
    Aabb& result = args.boxes[i];
    if (root) {
      const Aabb box{root->box_min, root->box_max};
      result = transform(box);
      args.placed[i] = place(transform, box, args.mesh_index[i]);
      args.mesh_height[0] = std::max(args.mesh_height[0], root->height);
    } else {
      result = {vec3(infinity), vec3(-infinity)};
      args.placed[i] = {vec3(0), 0, vec3(0), 0, vec3(0), 0, vec3(0), NO_INSTANCE};
    }
    if (args.corners.value) args.corners[i] = {result.box_min, result.box_max, result.box_max};
  }
}

}  // namespace coppice::twins
