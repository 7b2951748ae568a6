#pragma once

#include <memory>

#include "scene/motion.h"
#include "scene/random.h"

namespace coppice {

// Two joints: one stands still, the other turns about z and goes along x; a weight that swings.
class SwingingRig : public Rig {
 public:
  Pose pose(double seconds) const override {
    Pose pose;
    const auto c = static_cast<float>(std::cos(seconds)), s = static_cast<float>(std::sin(seconds));
    glm::mat4 turning(1.0f);
    turning[0] = {c, s, 0, 0};
    turning[1] = {-s, c, 0, 0};
    turning[3] = {static_cast<float>(seconds), 0, 0, 1};
    pose.joints = {glm::mat4(1.0f), turning};
    pose.morph_weights = {0.25f, static_cast<float>(std::sin(3 * seconds))};
    return pose;
  }
};

// Parts that go every way there is: a sequence with a morph target, morph targets alone, a deformation of
// each kind, one of them twice, a part that nothing bends; all of it skinned.
inline Scene all_that_moves(std::uint32_t part_triangles) {
  Scene scene;
  scene.name = "all that moves";
  Random random(7);
  const std::uint32_t part_vertices = 3 * part_triangles, parts = 9;
  const auto draw = [&](float size) {
    const glm::vec3 point = random.in_cube();
    return size * point;
  };
  for (std::uint32_t i = 0; i < parts * part_triangles; ++i) {
    const glm::vec3 a = draw(5);
    for (int corner = 0; corner < 3; ++corner) scene.positions.push_back(a + draw(0.5f));
    scene.indices.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    scene.material_index.push_back(0);
  }
  const auto part = [&](std::uint32_t index) { return VertexRange{index * part_vertices, part_vertices}; };
  const auto motion = std::make_shared<Motion>();
  motion->rest = scene.positions;
  VertexSequence sequence{.vertices = part(0), .frames_per_second = 4, .interpolates = true, .repeats = true};
  for (std::uint32_t v = 0; v < 3 * part_vertices; ++v) sequence.positions.push_back(draw(4));
  motion->sequences.push_back(sequence);
  for (const std::uint32_t at : {0u, 1u, 1u}) {
    MorphTarget morph{part(at), at, {}};
    for (std::uint32_t v = 0; v < part_vertices; ++v) morph.offsets.push_back(draw(0.3f));
    motion->morphs.push_back(morph);
  }
  for (const std::uint32_t kind : {0u, 1u, 2u, 3u, 4u, 0u})
    motion->deformations.push_back({.vertices = part(2 + std::min(kind, 4u)),
                                    .kind = static_cast<DeformKind>(kind),
                                    .centre = {0.5f, -1, 0.25f},
                                    .size = 3,
                                    .amount = 0.3f,
                                    .seconds = 1.5f + static_cast<float>(kind)});
  motion->deformations.push_back(motion->deformations[1]);  // once more: back to where it came from
  for (std::size_t v = 0; v < motion->rest.size(); ++v) {
    const auto one = static_cast<std::uint16_t>(v % 2);
    motion->joints.push_back({one, static_cast<std::uint16_t>(1 - one), 0, 0});
    const float weight = random.uniform();
    motion->weights.emplace_back(weight, v % 5 == 0 ? 0.0f : 1 - weight, 0, 0);
  }
  motion->rig = std::make_shared<SwingingRig>();
  scene.motion = motion;
  scene.positions = positions_at(*motion, 0);
  return scene;
}

}  // namespace coppice
