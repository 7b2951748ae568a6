#include "scene/motion.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>

namespace coppice {

namespace {

constexpr double TURN = 2 * std::numbers::pi;

double wave_of(double turns) { return std::sin(TURN * turns); }

glm::dvec3 turned_about_y(glm::dvec3 p, double turns) {
  const double c = std::cos(TURN * turns), s = std::sin(TURN * turns);
  return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

// Three numbers in [-1, 1) of a piece's own (Jarzynski and Olano 2020, pcg3d).
glm::dvec3 piece_draws(std::uint32_t piece) {
  glm::uvec3 v{piece, piece ^ 0x9e3779b9u, ~piece};
  for (int c = 0; c < 3; ++c) v[c] = v[c] * 1664525u + 1013904223u;
  const auto mix = [&] {
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
  };
  mix();
  for (int c = 0; c < 3; ++c) v[c] ^= v[c] >> 16;
  mix();
  const auto draw = [](std::uint32_t x) { return static_cast<double>(x >> 8) * 0x1p-23 - 1; };
  return {draw(v.x), draw(v.y), draw(v.z)};
}

// Where a vertex comes to, in sizes from the centre; `phase` in turns. `first` is that of its piece.
glm::dvec3 deformed(const Deformation& how, glm::dvec3 q, glm::dvec3 first, std::uint32_t piece,
                    double phase) {
  switch (how.kind) {
    case DeformKind::wave:
      return q + glm::dvec3{0, how.amount * (wave_of(2 * q.x - phase) + 0.5 * wave_of(3 * q.z + phase)), 0};
    case DeformKind::twist:
      return turned_about_y(q, how.amount * q.y * wave_of(phase));
    case DeformKind::explode: {
      const glm::dvec3 draws = piece_draws(piece);
      const double away = 0.5 - 0.5 * std::cos(TURN * phase);
      return first + turned_about_y(q - first, 2 * away * draws.x) +
             (first + 0.5 * draws) * (how.amount * away);
    }
    case DeformKind::swarm: {
      const glm::dvec3 draws = piece_draws(piece);
      const double turns = phase * (1 + std::floor(1.5 * (draws.y + 1)));
      const double up = how.amount * wave_of(phase + draws.z);
      return turned_about_y(q, draws.x < 0 ? -turns : turns) + glm::dvec3{0, up, 0};
    }
    case DeformKind::sway: {
      const double height = std::max(q.y, 0.0), bend = how.amount * height * height;
      const auto swing = [](double at, double start) { return wave_of(at) - wave_of(start); };
      return q + glm::dvec3{bend * swing(phase + q.x, q.x), 0, 0.5 * bend * swing(2 * phase + q.z, q.z)};
    }
  }
  return q;
}

void follow_sequence(const VertexSequence& sequence, double seconds, std::vector<glm::dvec3>& positions) {
  const SequenceTime time = time_in(sequence, seconds);
  const std::size_t count = sequence.vertices.count;
  for (std::size_t v = 0; v < count; ++v) {
    const glm::dvec3 a = sequence.positions[time.frame * count + v];
    const glm::dvec3 b = sequence.positions[time.next_frame * count + v];
    positions[sequence.vertices.first + v] = time.part == 0 ? a : a + (b - a) * double{time.part};
  }
}

void deform(const Deformation& how, double seconds, std::vector<glm::dvec3>& positions) {
  const double phase = phase_of(how, seconds), size = how.size;
  const glm::dvec3 centre = how.centre;
  glm::dvec3 first{};
  for (std::uint32_t v = 0; v < how.vertices.count; ++v) {
    glm::dvec3& position = positions[how.vertices.first + v];
    const glm::dvec3 q = (position - centre) / size;
    if (v % how.piece_vertices == 0) first = q;
    position = centre + size * deformed(how, q, first, v / how.piece_vertices, phase);
  }
}

// By the joints: the mean of where each of the four takes it, by weight.
glm::dvec3 posed(const Motion& motion, const Pose& pose, std::size_t vertex, glm::dvec3 position) {
  const glm::dvec4 at{position, 1};
  if (motion.joints.empty()) return glm::dvec3(glm::dmat4(pose.joints[0]) * at);
  glm::dvec3 sum{0};
  for (int k = 0; k < 4; ++k) {
    const double weight = motion.weights[vertex][k];
    if (weight != 0) sum += weight * glm::dvec3(glm::dmat4(pose.joints[motion.joints[vertex][k]]) * at);
  }
  return sum;
}

}  // namespace

SequenceTime time_in(const VertexSequence& sequence, double seconds) {
  const std::uint32_t frames = sequence.frame_count();
  if (frames == 0) return {0, 0, 0};
  double at = (seconds - sequence.first_second) * sequence.frames_per_second;
  if (sequence.repeats) at -= std::floor(at / frames) * frames;
  at = std::min(std::max(at, 0.0), static_cast<double>(frames) - (sequence.repeats ? 0.0 : 1.0));
  const auto frame = std::min(static_cast<std::uint32_t>(at), frames - 1);
  const std::uint32_t next = frame + 1 < frames ? frame + 1 : sequence.repeats ? 0 : frame;
  return {frame, next, sequence.interpolates ? static_cast<float>(at - frame) : 0.0f};
}

float phase_of(const Deformation& deformation, double seconds) {
  const double cycles = seconds / deformation.seconds;
  return static_cast<float>(cycles - std::floor(cycles));
}

std::optional<SceneCycle> cycle_of(const Scene& scene) {
  if (scene.motion) return SceneCycle{scene.motion->duration_seconds, scene.motion->frames_per_second};
  if (scene.swarm) return SceneCycle{scene.swarm->seconds, scene.swarm->frames_per_second};
  return {};
}

Motion motion_of(const Scene& scene) {
  if (scene.motion) return *scene.motion;
  Motion still;
  still.rest = scene.positions;
  return still;
}

Pose pose_at(const Motion& motion, double seconds) {
  Pose pose;
  if (motion.rig) pose = motion.rig->pose(seconds);
  if (pose.joints.empty()) pose.joints.emplace_back(1.0f);
  for (glm::mat4& joint : pose.joints) joint = glm::mat4(motion.to_scene * glm::dmat4(joint));
  if (pose.camera) {
    Camera& camera = *pose.camera;
    camera.position = glm::vec3(motion.to_scene * glm::dvec4(camera.position, 1));
    camera.target = glm::vec3(motion.to_scene * glm::dvec4(camera.target, 1));
    camera.up = glm::vec3(glm::normalize(glm::dmat3(motion.to_scene) * glm::dvec3(camera.up)));
  }
  return pose;
}

std::vector<glm::mat4x3> instances_at(const Motion& motion, double seconds) {
  std::vector<glm::mat4x3> result;
  if (motion.moved_instances.empty()) return result;
  for (const glm::dmat4& place : motion.rig->instances(seconds))
    result.emplace_back(glm::dmat4x3(motion.to_scene * place));
  return result;
}

std::vector<glm::vec3> positions_at(const Motion& motion, double seconds) {
  const Pose pose = pose_at(motion, seconds);
  std::vector<glm::dvec3> positions(motion.rest.begin(), motion.rest.end());
  for (const VertexSequence& sequence : motion.sequences) follow_sequence(sequence, seconds, positions);
  for (const MorphTarget& morph : motion.morphs) {
    const double weight = pose.morph_weights[morph.weight];
    for (std::uint32_t v = 0; weight != 0 && v < morph.vertices.count; ++v)
      positions[morph.vertices.first + v] += weight * glm::dvec3(morph.offsets[v]);
  }
  for (const Deformation& deformation : motion.deformations) deform(deformation, seconds, positions);
  std::vector<glm::vec3> result(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    result[v] = glm::vec3(posed(motion, pose, v, positions[v]));
  return result;
}

}  // namespace coppice
