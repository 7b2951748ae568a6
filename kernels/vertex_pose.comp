// In:  positions, the joints of each vertex and their weights. Out: the sum of weight * (joint * position) over the four,
// in their order (glTF 2.0, 3.7.3.3); a joint without weight is not read. Without joints of their own, where joint 0
// takes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "interface/vertex.h"
#include "lib/subgroup_run.glsl"

layout(local_size_x = VERTEX_GROUP) in;
layout(push_constant, scalar) uniform Push { VertexPoseArgs args; };

float along(vec4 row, vec3 p) {
  precise float place = row.x * p.x + row.y * p.y + row.z * p.z + row.w;
  return place;
}

vec3 taken_by(Joint joint, vec3 p) {
  return vec3(along(joint.rows[0], p), along(joint.rows[1], p), along(joint.rows[2], p));
}

vec3 add_weighted(vec3 sum, vec3 place, float weight) {
  precise vec3 part = place * weight;
  precise vec3 result = sum + part;
  return result;
}

vec3 taken_by_four(VertexJoints by, vec3 p) {
  uint joints[4] = {by.indices.x & 0xffffu, by.indices.x >> 16, by.indices.y & 0xffffu, by.indices.y >> 16};
  vec3 sum = vec3(0.0);
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    if (by.weights[k] == 0.0) continue;
    sum = add_weighted(sum, taken_by(args.joints.at[joints[k]], p), by.weights[k]);
  }
  return sum;
}

void main() {
  Run run = subgroup_run(gl_WorkGroupID.x * VERTEX_TILE, VERTICES_PER_INVOCATION, args.vertex_count);
  Joint whole = args.joints.at[0];
  bool skinned = uint64_t(args.by) != 0ul;
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    vec3 p = vec3(args.source.at[3u * i], args.source.at[3u * i + 1u], args.source.at[3u * i + 2u]);
    vec3 place = skinned ? taken_by_four(args.by.at[i], p) : taken_by(whole, p);
    args.vertices.at[3u * i] = place.x;
    args.vertices.at[3u * i + 1u] = place.y;
    args.vertices.at[3u * i + 2u] = place.z;
  }
}
