#include "render/moving_vertices.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "stages/stages.h"

namespace coppice {

namespace {

static_assert(static_cast<uint>(DeformKind::wave) == DEFORM_WAVE &&
              static_cast<uint>(DeformKind::sway) == DEFORM_SWAY);

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument("motion: " + why); }

// What one vertex range goes through: where its positions lie so far.
class WayOfRanges {
 public:
  WayOfRanges(MovingVertices& plan) : plan_(plan) {}

  // Throws for one that another range overlaps.
  Slot<float>& at(const VertexRange& range) {
    const std::uint64_t end = std::uint64_t{range.first} + range.count;
    if (end > plan_.vertex_count) refuse("vertices " + name(range) + " beyond the last one");
    for (const auto& [first, way] : ways_) {
      const std::uint64_t way_end = std::uint64_t{first} + way.count;
      const bool same = first == range.first && way.count == range.count;
      if (!same && range.first < way_end && first < end)
        refuse("vertices " + name(range) + " overlap " + name({first, way.count}));
    }
    return ways_.try_emplace(range.first, Way{range.count, plan_.rest}).first->second.from;
  }

  // Parts of a range that go the same way so far: one for each range within it, and one for each gap.
  std::vector<VertexRange> parts_of(const VertexRange& range) const {
    std::vector<VertexRange> parts;
    std::uint32_t done = range.first;
    const auto add = [&](std::uint32_t end) {
      if (end > done) parts.push_back({done, end - done});
      done = std::max(done, end);
    };
    const std::uint32_t end = range.first + range.count;
    for (const auto& [first, way] : ways_) {
      if (first < range.first || first >= end || first + way.count > end) continue;
      add(first);
      add(first + way.count);
    }
    add(end);
    return parts;
  }

  // All vertices, in order, those that no stage touches too; neighbours of one slot are one.
  std::vector<MovingVertices::Run> runs() const {
    std::vector<MovingVertices::Run> runs;
    const auto add = [&](std::uint32_t first, std::uint32_t end, const Slot<float>& from) {
      if (first == end) return;
      if (!runs.empty() && same_place(runs.back().from, from)) {
        runs.back().vertices.count += end - first;
      } else {
        runs.push_back({{first, end - first}, from});
      }
    };
    std::uint32_t done = 0;
    for (const auto& [first, way] : ways_) {
      add(done, first, plan_.rest);
      add(first, first + way.count, way.from);
      done = first + way.count;
    }
    add(done, plan_.vertex_count, plan_.rest);
    return runs;
  }

 private:
  struct Way {
    std::uint32_t count;
    Slot<float> from;
  };
  static bool same_place(const Slot<float>& a, const Slot<float>& b) {
    return a.place.block == b.place.block && a.place.offset == b.place.offset;
  }
  static std::string name(const VertexRange& range) {
    return std::to_string(range.first) + " to " + std::to_string(std::uint64_t{range.first} + range.count);
  }

  MovingVertices& plan_;
  std::map<std::uint32_t, Way> ways_;  // by the first vertex
};

void check(const Motion& motion) {
  const Pose pose = pose_at(motion, 0);
  if (3 * std::uint64_t{motion.rest.size()} > std::uint64_t{65535} * VERTEX_TILE)
    refuse(std::to_string(motion.rest.size()) + " vertices, more than " +
           std::to_string(65535u * VERTEX_TILE / 3));
  for (const VertexSequence& sequence : motion.sequences) {
    if (sequence.vertices.count > 0 && sequence.frame_count() == 0) refuse("a sequence without frames");
  }
  for (const MorphTarget& morph : motion.morphs) {
    if (morph.weight >= pose.morph_weights.size()) refuse("a morph target without weight");
    if (morph.offsets.size() != morph.vertices.count) refuse("a morph target of other vertices");
  }
  for (const Deformation& deformation : motion.deformations) {
    if (!(deformation.size > 0) || deformation.piece_vertices == 0) refuse("a deformation of no size");
  }
  if (motion.joints.size() != motion.weights.size() ||
      (!motion.joints.empty() && motion.joints.size() != motion.rest.size()))
    refuse("joints of other vertices");
  for (const auto& four : motion.joints) {
    if (*std::ranges::max_element(four) >= pose.joints.size()) refuse("a joint that no pose has");
  }
}

// The part of a slot of all vertices that belongs to a range.
Address<float> coordinates_at(const Chain& chain, const Slot<float>& slot, const VertexRange& range) {
  return chain.at(slot, std::uint64_t{3} * range.first);
}

// Pieces move as one and are counted from the first vertex, so their range stays whole.
void plan_deformation(MovingVertices& plan, WayOfRanges& ways, std::size_t index, const Deformation& how) {
  if (how.vertices.count == 0) return;
  const bool whole = how.kind == DeformKind::explode || how.kind == DeformKind::swarm;
  for (const VertexRange& part :
       whole ? std::vector<VertexRange>{how.vertices} : ways.parts_of(how.vertices)) {
    Slot<float>& from = ways.at(part);
    const bool in_first =
        from.place.block == plan.bent[0].place.block && from.place.offset == plan.bent[0].place.offset;
    const Slot<float> to = plan.bent[in_first ? 1 : 0];
    plan.deformations.push_back({index, part, from, to});
    from = to;
  }
}

}  // namespace

MovingVertices plan_vertices(Layout& layout, const Motion& motion, std::uint32_t triangle_count) {
  check(motion);
  MovingVertices plan;
  plan.vertex_count = static_cast<std::uint32_t>(motion.rest.size());
  const std::uint64_t coordinates = 3 * motion.rest.size();
  plan.rest = layout.add<float>("rest", coordinates);
  plan.vertices = layout.add<float>("vertices", coordinates);
  plan.indices = layout.add<uvec3>("indices", triangle_count);
  plan.by = layout.add<VertexJoints>("vertex_joints", motion.joints.size());
  const bool bends = !motion.sequences.empty() || !motion.morphs.empty() || !motion.deformations.empty();
  plan.bent[0] = layout.add<float>("bent", bends ? coordinates : 0);
  plan.bent[1] = layout.add<float>("bent_again", motion.deformations.empty() ? 0 : coordinates);

  WayOfRanges ways(plan);
  for (std::size_t i = 0; i < motion.sequences.size(); ++i) {
    const VertexSequence& sequence = motion.sequences[i];
    plan.sequence_positions.push_back(layout.add<float>("sequence", 3 * sequence.positions.size()));
    if (sequence.vertices.count == 0) continue;
    ways.at(sequence.vertices) = plan.bent[0];
    plan.sequences.push_back({i, sequence.vertices, {}, plan.bent[0]});
  }
  for (std::size_t i = 0; i < motion.morphs.size(); ++i) {
    const VertexRange& range = motion.morphs[i].vertices;
    plan.morph_offsets.push_back(layout.add<float>("morph_offsets", 3 * motion.morphs[i].offsets.size()));
    if (range.count == 0) continue;
    Slot<float>& from = ways.at(range);
    plan.morphs.push_back({i, range, from, plan.bent[0]});
    from = plan.bent[0];
  }
  for (std::size_t i = 0; i < motion.deformations.size(); ++i)
    plan_deformation(plan, ways, i, motion.deformations[i]);
  plan.runs = ways.runs();
  return plan;
}

MotionSlots plan_motion(Layout& layout, const Motion& motion) {
  const Pose pose = pose_at(motion, 0);
  return {layout.add_mapped<SequenceStep>("sequence_steps", motion.sequences.size()),
          layout.add_mapped<DeformStep>("deform_steps", motion.deformations.size()),
          layout.add_mapped<float>("morph_weights", pose.morph_weights.size()),
          layout.add_mapped<Joint>("joints", pose.joints.size())};
}

void append_vertices(Chain& chain, const MovingVertices& plan, const MotionSlots& at, const Motion& motion) {
  for (const MovingVertices::Stage& stage : plan.sequences) {
    const VertexRange& range = stage.vertices;
    chain.run(stages::vertex_sequence,
              {chain.at(plan.sequence_positions[stage.of]), chain.at(at.sequences, stage.of),
               coordinates_at(chain, stage.target, range), 3 * range.count, 0},
              groups_of(3 * range.count, VERTEX_TILE));
  }
  for (const MovingVertices::Stage& stage : plan.morphs) {
    const MorphTarget& morph = motion.morphs[stage.of];
    const std::uint32_t count = 3 * morph.vertices.count;
    chain.run(stages::vertex_morph,
              {chain.at(plan.morph_offsets[stage.of]), chain.at(at.morph_weights, morph.weight),
               coordinates_at(chain, stage.source, morph.vertices),
               coordinates_at(chain, stage.target, morph.vertices), count, 0},
              groups_of(count, VERTEX_TILE));
  }
  for (const MovingVertices::Stage& stage : plan.deformations) {
    const VertexRange& range = stage.vertices;
    chain.run(stages::vertex_deform,
              {chain.at(at.deformations, stage.of), coordinates_at(chain, stage.source, range),
               coordinates_at(chain, stage.target, range), range.count, 0},
              groups_of(range.count, VERTEX_TILE));
  }
  for (const MovingVertices::Run& run : plan.runs) {
    const Address<VertexJoints> none{};
    chain.run(stages::vertex_pose,
              {coordinates_at(chain, run.from, run.vertices),
               plan.by.count == 0 ? none : chain.at(plan.by, run.vertices.first), chain.at(at.joints),
               coordinates_at(chain, plan.vertices, run.vertices), run.vertices.count, 0},
              groups_of(run.vertices.count, VERTEX_TILE));
  }
}

VertexTriangles triangles_of(const Chain& chain, const MovingVertices& plan) {
  return {.vertices = {chain.at(plan.vertices).value},
          .indices = {chain.at(plan.indices).value},
          .vertex_count = plan.vertex_count};
}

MotionStep motion_step(const Motion& motion, const Pose& pose, double seconds) {
  MotionStep step;
  for (const VertexSequence& sequence : motion.sequences) {
    const SequenceTime time = time_in(sequence, seconds);
    step.sequences.push_back({time.frame, time.next_frame, time.part, 0});
  }
  for (const Deformation& d : motion.deformations) {
    step.deformations.push_back({d.centre, d.size, 1 / d.size, d.amount, phase_of(d, seconds),
                                 static_cast<uint>(d.kind), d.piece_vertices, 0});
  }
  step.morph_weights = pose.morph_weights;
  for (const glm::mat4& matrix : pose.joints) {
    Joint& joint = step.joints.emplace_back();
    for (int row = 0; row < 3; ++row)
      joint.rows[row] = {matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]};
  }
  return step;
}

std::vector<VertexJoints> vertex_joints(const Motion& motion) {
  std::vector<VertexJoints> result;
  for (std::size_t v = 0; v < motion.joints.size(); ++v) {
    const auto& four = motion.joints[v];
    const auto pair = [&](int k) { return four[k] | static_cast<uint>(four[k + 1]) << 16; };
    result.push_back({{pair(0), pair(2)}, motion.weights[v], {}});
  }
  return result;
}

}  // namespace coppice
