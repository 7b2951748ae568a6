#include "stages/stages.h"

// What the stages that move vertices move at least, of memory: "cost" in docs/kernels.md.
namespace coppice::traffic {

// Frames of a sequence are read once each frame of the scene, and two where it lies between them.
Bytes vertex_sequence(const VertexSequenceArgs& a, const RunCounts&) {
  return Bytes{a.coordinate_count} * 2 * sizeof(float);
}

Bytes vertex_morph(const VertexMorphArgs& a, const RunCounts&) {
  return Bytes{a.coordinate_count} * 3 * sizeof(float);
}

Bytes vertex_deform(const VertexDeformArgs& a, const RunCounts&) {
  return Bytes{a.vertex_count} * 2 * sizeof(vec3);
}

Bytes vertex_pose(const VertexPoseArgs& a, const RunCounts&) {
  return Bytes{a.vertex_count} * (2 * sizeof(vec3) + (a.by.value ? sizeof(VertexJoints) : 0));
}

}  // namespace coppice::traffic
