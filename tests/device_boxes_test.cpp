// Boxes that the caller gives: in lockstep with the twins, and the tree over them is that of triangles with
// these boxes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>

#include "analysis/tree_hash.h"
#include "builders/ploc.h"
#include "support/counted_run.h"
#include "support/device_run.h"

namespace coppice {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity_value = std::numeric_limits<float>::infinity();

class DeviceBoxes : public DeviceTest {
 protected:
  struct BuiltOverBoxes {
    std::vector<Node> nodes;
    BuildState state;
  };

  static BuiltOverBoxes build(const std::vector<Aabb>& boxes, std::uint32_t stride,
                              const BuildOptions& options = {}, std::optional<uint> asked = {}) {
    const auto count = static_cast<std::uint32_t>(boxes.size());
    CountedRun run;
    const auto given = run.layout.add<std::byte>("given", 4 + boxes.size() * stride);
    const BuildPlan plan = plan_build(run.layout, count, options, PrimitiveKind::boxes);
    EXPECT_EQ(plan.triangles.count, 0u);
    run.start(asked.value_or(0));
    std::vector<std::byte> bytes(given.count, std::byte{0xff});
    for (std::size_t i = 0; i < boxes.size(); ++i)
      std::memcpy(&bytes[4 + i * stride], &boxes[i], sizeof(Aabb));
    run.upload(given, bytes);
    run.expect_same_bits([&](Chain& chain) {
      append_build(
          chain, plan,
          {GivenBoxes{{chain.at(given, 4).value}, stride}, asked ? chain.at(run.count) : UintBuffer{}});
    });
    BuiltOverBoxes built{run.read(plan.nodes), run.read(plan.state)[0]};
    if (const std::uint64_t active = built.state.active_count)
      built.nodes.resize(2 * active - 1);
    else
      built.nodes.clear();
    return built;
  }

  static std::vector<Aabb> boxes_of(std::span<const Triangle> triangles) {
    std::vector<Aabb> boxes;
    for (const Triangle& t : triangles)
      boxes.push_back({glm::min(glm::min(t.a, t.b), t.c), glm::max(glm::max(t.a, t.b), t.c)});
    return boxes;
  }
};

TEST_F(DeviceBoxes, TheTreeOfTrianglesWithTheseBoxesByEveryBuilder) {
  const std::vector<Triangle> triangles = random_triangles(5000, 21);
  for (const NamedDeviceBuilder& builder : device_builders()) {
    BuildOptions options;
    options.builder = builder.builder;
    const std::uint64_t hash = tree_hash(build_on(test_device(), triangles, options).nodes);
    for (const std::uint32_t stride : {24u, 28u, 32u, 64u})
      EXPECT_EQ(tree_hash(build(boxes_of(triangles), stride, options).nodes), hash) << builder.name << stride;
  }
}

TEST_F(DeviceBoxes, NotFiniteOrInsideOutAreInactive) {
  std::vector<Aabb> boxes = boxes_of(random_triangles(100, 22));
  const std::size_t before = boxes.size();
  const vec3 low(0.25f), high(0.75f);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float bad : {not_a_number, infinity_value, -infinity_value}) {
      Aabb box{low, high};
      box.box_min[axis] = bad;
      boxes.push_back(box);
      box = {low, high};
      box.box_max[axis] = bad;
      boxes.push_back(box);
    }
    Aabb inside_out{low, high};
    inside_out.box_min[axis] = std::nextafter(high[axis], 1.0f);
    boxes.push_back(inside_out);
  }
  const BuiltOverBoxes with = build(boxes, 24);
  EXPECT_EQ(with.state.active_count, before);
  boxes.resize(before);
  EXPECT_EQ(tree_hash(with.nodes), tree_hash(build(boxes, 24).nodes));
  const vec3 least_denormal(1e-45f);
  boxes.push_back({least_denormal, -least_denormal});  // both are 0
  boxes.push_back({vec3(0.0f), vec3(-0.0f)});
  EXPECT_EQ(build(boxes, 24).state.active_count, before + 2);
}

TEST_F(DeviceBoxes, CountsOnTheDevice) {
  const std::vector<Triangle> triangles = random_triangles(2000, 23);
  for (const uint asked : {0u, 1u, 1024u, 1999u, 2000u, 2001u}) {
    const BuiltOverBoxes built = build(boxes_of(triangles), 32, {}, asked);
    EXPECT_EQ(built.state.primitive_count, asked);
    EXPECT_EQ(built.state.error_word, asked > 2000 ? ERROR_COUNT : 0u);
    const std::size_t count = asked > 2000 ? 0 : asked;
    EXPECT_EQ(tree_hash(built.nodes),
              tree_hash(build_ploc(std::span(triangles).first(count), {16, 30}).nodes));
  }
}

}  // namespace
}  // namespace coppice
