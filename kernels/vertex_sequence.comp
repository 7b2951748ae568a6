// In:  positions of a sequence, frame by frame, and where between two frames a time lies. Out: the positions at that
// time, a + (b - a) * part; those of the first frame, bit for bit, where the part is 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "interface/vertex.h"
#include "lib/subgroup_run.glsl"

layout(local_size_x = VERTEX_GROUP) in;
layout(push_constant, scalar) uniform Push { VertexSequenceArgs args; };

float between(float a, float b, float part) {
  precise float way = (b - a) * part;
  precise float place = a + way;
  return place;
}

void main() {
  SequenceStep at = args.at.at[0];
  uint64_t frame_bytes = uint64_t(args.coordinate_count) * 4ul;
  FloatBuffer first = FloatBuffer(uint64_t(args.positions) + at.frame * frame_bytes);
  FloatBuffer next = FloatBuffer(uint64_t(args.positions) + at.next_frame * frame_bytes);
  Run run = subgroup_run(gl_WorkGroupID.x * VERTEX_TILE, VERTICES_PER_INVOCATION, args.coordinate_count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    float place = first.at[i];
    if (at.part != 0.0) place = between(place, next.at[i], at.part);
    args.vertices.at[i] = place;
  }
}
