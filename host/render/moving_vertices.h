#pragma once

#include <vector>

#include "interface/vertex.h"
#include "pipeline/primitives.h"
#include "scene/motion.h"

namespace coppice {

// What a frame is told of where its vertices are. Mapped: the host writes it, and the frame reads it.
struct MotionSlots {
  Slot<SequenceStep> sequences;  // one a sequence
  Slot<DeformStep> deformations;
  Slot<float> morph_weights;
  Slot<Joint> joints;
};

// Where the vertices of a moving scene are kept, and on their way.
struct MovingVertices {
  // Vertices that go the same way, and where the position of the last stage before the pose lies.
  struct Run {
    VertexRange vertices;
    Slot<float> from;
  };
  struct Stage {
    std::size_t of;              // its index among the sequences, morph targets or deformations
    VertexRange vertices;        // its own, or a part of them
    Slot<float> source, target;  // of all vertices
  };

  std::uint32_t vertex_count = 0;
  Slot<float> rest, bent[2];  // three coordinates a vertex
  Slot<float> vertices;       // in the end
  Slot<uvec3> indices;        // of the triangles
  Slot<VertexJoints> by;      // none where joint 0 takes all
  std::vector<Slot<float>> sequence_positions, morph_offsets;
  std::vector<Stage> sequences, morphs, deformations;
  std::vector<Run> runs;
};

// Slots of the vertices, with room for so many triangles' indices. Throws
// LayoutError if one does not fit a block, and std::invalid_argument for ranges that overlap and are not the
// same (but a deformation without pieces may have several others within it), or lie outside of the vertices,
// for joints and weights that no pose has, and for more vertices than a dispatch takes.
MovingVertices plan_vertices(Layout& layout, const Motion& motion, std::uint32_t triangle_count);
MotionSlots plan_motion(Layout& layout, const Motion& motion);

// To MovingVertices::vertices where they are by `at`.
void append_vertices(Chain& chain, const MovingVertices& plan, const MotionSlots& at, const Motion& motion);

// The triangles, for a build.
VertexTriangles triangles_of(const Chain& chain, const MovingVertices& plan);

// As `at` holds it.
struct MotionStep {
  std::vector<SequenceStep> sequences;
  std::vector<DeformStep> deformations;
  std::vector<float> morph_weights;
  std::vector<Joint> joints;
};
MotionStep motion_step(const Motion& motion, const Pose& pose, double seconds);

template <class Executor>
void upload_step(Executor& executor, const MotionSlots& at, const MotionStep& step) {
  executor.upload(at.sequences, std::span<const SequenceStep>(step.sequences));
  executor.upload(at.deformations, std::span<const DeformStep>(step.deformations));
  executor.upload(at.morph_weights, std::span<const float>(step.morph_weights));
  executor.upload(at.joints, std::span<const Joint>(step.joints));
}

// One a vertex; empty where joint 0 takes all.
std::vector<VertexJoints> vertex_joints(const Motion& motion);

// What no frame changes. `indices` are the scene's.
template <class Executor>
void upload_vertices(Executor& executor, const MovingVertices& plan, const Motion& motion,
                     std::span<const uvec3> indices) {
  const auto coordinates = [](const std::vector<vec3>& positions) {
    return std::span<const float>(reinterpret_cast<const float*>(positions.data()), 3 * positions.size());
  };
  executor.upload(plan.rest, coordinates(motion.rest));
  executor.upload(plan.indices, indices);
  for (std::size_t i = 0; i < motion.sequences.size(); ++i)
    executor.upload(plan.sequence_positions[i], coordinates(motion.sequences[i].positions));
  for (std::size_t i = 0; i < motion.morphs.size(); ++i)
    executor.upload(plan.morph_offsets[i], coordinates(motion.morphs[i].offsets));
  executor.upload(plan.by, std::span<const VertexJoints>(vertex_joints(motion)));
}

}  // namespace coppice
