#include "interface/vertex.h"

namespace coppice::twins {

namespace {

vec3 by_joint(const Joint& joint, const float* p) {
  vec3 place;
  for (int axis = 0; axis < 3; ++axis) {
    const vec4& row = joint.rows[axis];
    place[axis] = row.x * p[0] + row.y * p[1] + row.z * p[2] + row.w;
  }
  return place;
}

}  // namespace

void vertex_pose(const VertexPoseArgs& args) {
  for (uint i = 0; i < args.vertex_count; ++i) {
    const float* const p = &args.source[std::size_t{3} * i];
    vec3 place(0);
    if (!args.by.value) place = by_joint(args.joints[0], p);
    for (int k = 0; args.by.value && k < 4; ++k) {
      const VertexJoints& by = args.by[i];
      const uint joint = by.indices[k / 2] >> (16 * (k % 2)) & 0xffff;
      if (by.weights[k] != 0) place += by_joint(args.joints[joint], p) * by.weights[k];
    }
    for (int axis = 0; axis < 3; ++axis) args.vertices[std::size_t{3} * i + axis] = place[axis];
  }
}

}  // namespace coppice::twins
