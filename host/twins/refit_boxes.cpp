#include <algorithm>

#include "twins/finite.h"
#include "twins/refit_box.h"

namespace coppice::twins {

bool is_active(const Triangle& triangle) {
  return all_finite(triangle.a) && all_finite(triangle.b) && all_finite(triangle.c);
}

void refit_leaf(Node& leaf, Address<const Triangle> triangles) {
  const Triangle& triangle = triangles[leaf.child];
  const bool active = is_active(triangle);
  for (int axis = 0; axis < 3; ++axis) {
    const float a = triangle.a[axis], b = triangle.b[axis], c = triangle.c[axis];
    leaf.box_min[axis] = active ? std::min({a, b, c}) : NOTHING_BOX;
    leaf.box_max[axis] = active ? std::max({a, b, c}) : -NOTHING_BOX;
  }
}

void refit_node(Address<Node> nodes, Address<const Triangle> triangles, uint index) {
  Node& node = nodes[index];
  Node *const left = &nodes[node.child], *const right = left + 1;
  for (Node* const child : {left, right}) {
    if (child->height == 0) refit_leaf(*child, triangles);
  }
  for (int axis = 0; axis < 3; ++axis) {
    node.box_min[axis] = std::min(left->box_min[axis], right->box_min[axis]);
    node.box_max[axis] = std::max(left->box_max[axis], right->box_max[axis]);
  }
}

void refit_boxes(const RefitBoxesArgs& args) {
  const RefitLevel& level = args.levels[args.level];
  for (uint i = level.first; i < level.first + level.count; ++i)
    refit_node(args.nodes, args.triangles, args.order[i]);
}

}  // namespace coppice::twins
