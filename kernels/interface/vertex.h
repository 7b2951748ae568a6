// Where vertices are in a frame: positions at rest, replaced, added to, bent and taken into the scene.
#ifndef COPPICE_INTERFACE_VERTEX_H
#define COPPICE_INTERFACE_VERTEX_H
#include "types.h"
#ifdef __cplusplus
#include <glm/vec4.hpp>
namespace coppice {
using glm::vec4;
}
#endif
INTERFACE_BEGIN

const uint VERTEX_GROUP = 64;
const uint VERTICES_PER_INVOCATION = 16;
const uint VERTEX_TILE = VERTEX_GROUP * VERTICES_PER_INVOCATION;

// Between which frames of a sequence a time lies, and which part of the way.
struct SequenceStep {
  uint frame, next_frame;
  float part;  // 0: the first one as it is
  uint padding;
};

// An affine transform: rows of a matrix of 3 x 4.
struct Joint {
  vec4 rows[3];
};

// Four joints, 16 bits each, the first in the low half of x.
struct VertexJoints {
  uvec2 indices;
  vec4 weights;
  uvec2 padding;
};

// What vertex_deform does; DeformKind in scene/motion.h says what they mean.
const uint DEFORM_WAVE = 0;
const uint DEFORM_TWIST = 1;
const uint DEFORM_EXPLODE = 2;
const uint DEFORM_SWARM = 3;
const uint DEFORM_SWAY = 4;

// A deformation at a time.
struct DeformStep {
  vec3 centre;
  float size;
  float inverse_size;
  float amount;
  float phase;          // in turns, 0 to 1
  uint kind;            // DEFORM_
  uint piece_vertices;  // at least 1
  uint padding;
};

INTERFACE_BUFFER(SequenceStepBuffer, SequenceStep, 4)
INTERFACE_BUFFER(DeformStepBuffer, DeformStep, 4)
INTERFACE_BUFFER(JointBuffer, Joint, 16)
INTERFACE_BUFFER(VertexJointsBuffer, VertexJoints, 8)

struct VertexSequenceArgs {
  READS(FloatBuffer) positions;  // frames of coordinate_count each
  READS(SequenceStepBuffer) at;  // one
  FloatBuffer vertices;          // coordinate_count, written
  uint coordinate_count;         // three a vertex
  uint padding;
};

struct VertexMorphArgs {
  READS(FloatBuffer) offsets;  // coordinate_count
  READS(FloatBuffer) weight;   // one
  READS(FloatBuffer) source;   // coordinate_count; may be the same as vertices
  FloatBuffer vertices;        // coordinate_count
  uint coordinate_count;
  uint padding;
};

struct VertexDeformArgs {
  READS(DeformStepBuffer) how;  // one
  READS(FloatBuffer) source;    // three coordinates a vertex
  FloatBuffer vertices;         // not the same
  uint vertex_count;
  uint padding;
};

struct VertexPoseArgs {
  READS(FloatBuffer) source;     // three coordinates a vertex
  READS(VertexJointsBuffer) by;  // one a vertex; null: joint 0
  READS(JointBuffer) joints;     // all that `by` names
  FloatBuffer vertices;          // not the same
  uint vertex_count;
  uint padding;
};

INTERFACE_END
#endif
