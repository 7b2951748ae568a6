// In:  positions and the offsets of one morph target. Out: position + offset * weight (glTF 2.0, 3.7.2.2).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/vertex.h"
#include "lib/subgroup_run.glsl"

layout(local_size_x = VERTEX_GROUP) in;
layout(push_constant, scalar) uniform Push { VertexMorphArgs args; };

float moved(float position, float offset, float weight) {
  precise float way = offset * weight;
  precise float place = position + way;
  return place;
}

void main() {
  float weight = args.weight.at[0];
  Run run = subgroup_run(gl_WorkGroupID.x * VERTEX_TILE, VERTICES_PER_INVOCATION, args.coordinate_count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES)
    args.vertices.at[i] = moved(args.source.at[i], args.offsets.at[i], weight);
}
