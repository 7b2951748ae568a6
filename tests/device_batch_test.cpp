// Each tree of a batch is, bit for bit, the tree of a build by itself of the same triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/tree_hash.h"
#include "builders/ploc.h"
#include "pipeline/batch.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "scene/random.h"
#include "stages/errors.h"
#include "support/counted_run.h"
#include "support/device_run.h"
#include "support/lockstep.h"
#include "support/random_scenes.h"

namespace coppice {
namespace {

// The triangles of all trees one after the other, and their ranges.
struct Batch {
  std::vector<Triangle> triangles;
  std::vector<BatchRange> ranges;

  void add(std::span<const Triangle> tree) {
    ranges.push_back({static_cast<uint>(triangles.size()), static_cast<uint>(tree.size())});
    triangles.insert(triangles.end(), tree.begin(), tree.end());
  }

  std::span<const Triangle> of(const BatchRange& range) const {
    return std::span(triangles).subspan(range.first, range.count);
  }
};

struct Built {
  std::vector<Node> nodes;
  std::vector<BatchTree> trees;
  BuildState state, primitives;
};

class DeviceBatch : public DeviceTest {
 protected:
  // With counts on the device where they are given.
  static Built build(const Batch& batch, const BuildOptions& options, std::optional<uint> ranges = {},
                     std::optional<uint> primitives = {}) {
    CountedRun run;
    const auto primitive_count = run.layout.add<uint>("primitive_count", 1);
    const BatchPlan plan = plan_batch(run.layout, static_cast<std::uint32_t>(batch.triangles.size()),
                                      static_cast<std::uint32_t>(batch.ranges.size()), options);
    run.start(ranges.value_or(0));
    run.upload(primitive_count, {primitives.value_or(0)});
    run.upload(plan.primitives.triangles, batch.triangles);
    run.upload(plan.ranges, batch.ranges);
    run.fill(plan.nodes);
    run.fill(plan.trees);
    run.expect_same_bits([&](Chain& chain) {
      BuildInput input;
      if (primitives) input.count_at = chain.at(primitive_count);
      append_batch(chain, plan, input, ranges ? chain.at(run.count) : UintBuffer{});
    });
    return {run.read(plan.nodes), run.read(plan.trees), run.read(plan.state)[0],
            run.read(plan.primitives.state)[0]};
  }

  static void expect_tree(const Built& built, std::size_t index, const BatchRange& range,
                          std::span<const Triangle> triangles, const BuildOptions& options) {
    const Bvh alone = build_ploc(triangles, {options.radius, options.morton_bits});
    const BatchTree& tree = built.trees[index];
    EXPECT_EQ(tree.active_count, alone.active_count) << "tree " << index;
    EXPECT_EQ(tree.round_count, alone.rounds) << "tree " << index;
    EXPECT_EQ(tree.error_word, 0u) << "tree " << index;
    const auto nodes =
        std::span(built.nodes).subspan(2 * std::size_t{range.first}, 2 * std::size_t{range.count});
    EXPECT_EQ(tree_hash(nodes.first(alone.nodes.size())), tree_hash(alone.nodes)) << "tree " << index;
    for (const Node& node : nodes.subspan(alone.nodes.size()))
      ASSERT_EQ(node.child, SENTINEL) << "behind tree " << index;
  }

  static void expect_trees(const Batch& batch, const BuildOptions& options = {}) {
    const Built built = build(batch, options);
    if (HasFatalFailure()) return;
    EXPECT_EQ(built.state.error_word, 0u);
    EXPECT_EQ(built.state.primitive_count, batch.ranges.size());
    for (std::size_t i = 0; i < batch.ranges.size(); ++i)
      expect_tree(built, i, batch.ranges[i], batch.of(batch.ranges[i]), options);
  }
};

TEST_F(DeviceBatch, EverySizeUpTo140AndThoseAboutPowersOfTwo) {
  Batch batch;
  for (std::uint32_t size = 0; size <= 140; ++size) batch.add(random_triangles(size, size));
  for (const std::uint32_t size : {255u, 256u, 257u, 300u, 511u, 512u})
    batch.add(random_triangles(size, size));
  expect_trees(batch);
}

TEST_F(DeviceBatch, EveryRadiusAndBothLengthsOfCodes) {
  Batch batch;
  for (const std::uint32_t size : {1u, 2u, 3u, 30u, 64u, 200u, 512u})
    batch.add(random_triangles(size, size + 1));
  for (const std::uint32_t radius : {1u, 2u, 7u, 8u, 16u, 33u, 100u}) {
    for (const std::uint32_t bits : {30u, 60u}) {
      SCOPED_TRACE("radius " + std::to_string(radius) + ", " + std::to_string(bits) + " bits");
      BuildOptions options;
      options.radius = radius;
      options.morton_bits = bits;
      expect_trees(batch, options);
    }
  }
}

// Ties, NaN, ends of the range of float, chains; with scales and places of their own, which the box about all
// of them is not to touch.
TEST_F(DeviceBatch, EveryHardCase) {
  for (const std::uint32_t bits : {30u, 60u}) {
    Batch batch;
    for (const HardCase& hard_case : hard_cases()) {
      for (const std::uint32_t size : {2u, 3u, 20u, 64u, 250u}) {
        const std::vector<Triangle> triangles = scene_arrays(hard_case.make(size, 1)).triangles;
        batch.add(std::span(triangles).first(std::min<std::size_t>(triangles.size(), BATCH_MAX_PRIMITIVES)));
      }
    }
    BuildOptions options;
    options.morton_bits = bits;
    expect_trees(batch, options);
  }
}

TEST_F(DeviceBatch, RandomScenes) {
  Batch batch;
  for_random_scenes(100, [&](RandomScene& scene) {
    batch.add(scene.triangles(1 + scene.random().below(BATCH_MAX_PRIMITIVES)));
  });
  expect_trees(batch);
}

TEST_F(DeviceBatch, WhereNoneIsActive) {
  Batch batch;
  const std::vector<Triangle> before = random_triangles(20, 1);
  std::vector<Triangle> none = before;
  for (Triangle& t : none) t.c.z = std::nanf("");
  batch.add(before), batch.add(none), batch.add({}), batch.add(before);
  expect_trees(batch);
}

// One tree of all the same code, and one of two places.
TEST_F(DeviceBatch, EqualCodesStayInOrder) {
  Batch batch;
  const Triangle triangle = random_triangles(1, 1)[0];
  batch.add(std::vector<Triangle>(512, triangle));
  std::vector<Triangle> two(300, triangle);
  for (std::size_t i = 0; i < two.size(); i += 2) two[i].a.x += 5, two[i].b.x += 5, two[i].c.x += 5;
  batch.add(two);
  expect_trees(batch);
}

// In any order, with gaps between.
TEST_F(DeviceBatch, RangesAnywhere) {
  const std::vector<Triangle> triangles = random_triangles(3000, 4);
  const Batch batch{triangles, {{2900, 100}, {5, 0}, {1000, 512}, {0, 1}, {3000, 0}, {17, 200}}};
  expect_trees(batch);
}

TEST_F(DeviceBatch, RangesTooLongOrBeyondThePrimitivesAreErrorsAndHaveNoTree) {
  const std::vector<Triangle> triangles = random_triangles(3000, 5);
  const Batch batch{
      triangles, {{0, 513}, {600, 64}, {2999, 2}, {~0u, 2}, {3001, 0}, {700, ~0u}, {~0u, ~0u}, {2500, 500}}};
  const Built built = build(batch, {});
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(built.state.error_word, ERROR_BATCH_RANGE);
  EXPECT_NE(describe_error_word(built.state.error_word).find("batch_build"), std::string::npos);
  for (const std::size_t i : {0u, 2u, 3u, 4u, 5u, 6u}) {
    EXPECT_EQ(built.trees[i].error_word, ERROR_BATCH_RANGE) << i;
    EXPECT_EQ(built.trees[i].active_count, 0u) << i;
  }
  for (const std::size_t i : {1u, 7u}) expect_tree(built, i, batch.ranges[i], batch.of(batch.ranges[i]), {});
  EXPECT_EQ(built.nodes[0].child, SENTINEL);
}

TEST_F(DeviceBatch, CountsOfRangesOnTheDevice) {
  Batch batch;
  for (std::uint32_t i = 0; i < 100; ++i) batch.add(random_triangles(10 + i % 7, i));
  for (const uint asked : {0u, 1u, 64u, 99u, 100u, 101u, ~0u}) {
    SCOPED_TRACE(std::to_string(asked));
    const Built built = build(batch, {}, asked);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(built.state.primitive_count, asked);
    EXPECT_EQ(built.state.error_word, asked > 100 ? ERROR_COUNT : 0u);
    const std::size_t count = std::min(asked, 100u);
    for (std::size_t i = 0; i < count; ++i)
      expect_tree(built, i, batch.ranges[i], batch.of(batch.ranges[i]), {});
    for (std::size_t i = count; i < 100; ++i) ASSERT_EQ(built.trees[i].active_count, SENTINEL);
  }
  const Built none = build({}, {}, 3);
  EXPECT_EQ(none.state.error_word, ERROR_COUNT);
}

// What reaches beyond them is an error, as what lies there has no boxes.
TEST_F(DeviceBatch, CountsOfPrimitivesOnTheDevice) {
  const std::vector<Triangle> triangles = random_triangles(500, 7);
  const Batch batch{triangles, {{0, 100}, {100, 200}, {300, 200}}};
  for (const uint asked : {0u, 100u, 299u, 300u, 499u, 500u, 501u}) {
    SCOPED_TRACE(std::to_string(asked));
    const Built built = build(batch, {}, {}, asked);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(built.primitives.primitive_count, asked);
    EXPECT_EQ(built.primitives.error_word, asked > 500 ? ERROR_COUNT : 0u);
    EXPECT_EQ(built.state.error_word, asked < 500 ? ERROR_BATCH_RANGE : 0u);
    for (std::size_t i = 0; i < 3; ++i) {
      const BatchRange& range = batch.ranges[i];
      if (range.first + range.count <= asked)
        expect_tree(built, i, range, batch.of(range), {});
      else
        EXPECT_EQ(built.trees[i].error_word, ERROR_BATCH_RANGE);
    }
  }
}

// More than one row of workgroups.
TEST_F(DeviceBatch, MoreThan65535Trees) {
  Batch batch;
  const std::vector<Triangle> triangles = random_triangles(5, 6);
  for (std::uint32_t i = 0; i < 70001; ++i) batch.add(std::span(triangles).first(i % 3));
  BuildOptions options;
  options.radius = 1;
  expect_trees(batch, options);
}

TEST(BatchPlan, RefusesOptionsOutOfRange) {
  Layout layout;
  EXPECT_THROW(plan_batch(layout, 10, 1, {.radius = 0}), std::invalid_argument);
  EXPECT_THROW(plan_batch(layout, 10, 1, {.morton_bits = 31}), std::invalid_argument);
  EXPECT_THROW(plan_batch(layout, max_triangles + 1, 1, {}), std::invalid_argument);
  EXPECT_EQ(ploc_rounds_bound(BATCH_MAX_PRIMITIVES, 1), BATCH_ROUNDS_BOUND);
}

}  // namespace
}  // namespace coppice
