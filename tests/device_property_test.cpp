// Random scenes with random options: every kernel gives the bits of its twin, the tree is valid, and it is
// that of the independent builder.
#include <gtest/gtest.h>

#include "analysis/validate.h"
#include "builders/ploc.h"
#include "stages/lockstep_executor.h"
#include "support/builders.h"
#include "support/random_scenes.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class DeviceProperty : public DeviceTest {};

// Only lookback_turns is compiled into pipelines: two values keep these few.
BuildOptions random_options(Random& random) {
  BuildOptions options;
  options.radius = random.below(16) == 0 ? PLOC_MAX_RADIUS : 1 + random.below(16);
  options.morton_bits = random.below(2) == 0 ? 30 : 60;
  const std::uint32_t sums = random.below(3);
  options.lookback = sums != 0;
  if (sums == 1) options.lookback_turns = 0;  // every tile sums up its predecessors itself
  return options;
}

// Mostly few enough for the finish to do all rounds; the others go through rounds of their own first.
std::uint32_t random_count(Random& random) {
  if (random.below(8) != 0) return 1 + random.below(300);
  return PLOC_FINISH_CLUSTERS + 1 + random.below(2000);
}

std::string described(std::uint32_t count, const BuildOptions& options) {
  return std::to_string(count) + " triangles, radius " + std::to_string(options.radius) + ", " +
         std::to_string(options.morton_bits) + " bits, lookback " + (options.lookback ? "on" : "off") + ", " +
         std::to_string(options.lookback_turns) + " turns";
}

void expect_right_tree(std::span<const Triangle> triangles, const BuildOptions& options) {
  Layout layout(test_device().properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
  LockstepExecutor executor(test_device(), layout);
  executor.upload(plan.triangles, triangles);
  const auto difference = executor.run([&](Chain& chain) { append_build(chain, plan); });
  ASSERT_FALSE(difference) << "stage " << difference->stage << ", " << difference->slot << "["
                           << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                           << difference->gpu;
  const BuildState state = executor.gpu().read(plan.state)[0];
  EXPECT_EQ(state.error_word, 0u);
  EXPECT_LE(state.round_count, plan.rounds_bound);

  Bvh bvh;
  bvh.active_count = state.active_count;
  const std::uint64_t nodes = state.active_count == 0 ? 0 : 2 * std::uint64_t{state.active_count} - 1;
  bvh.nodes = executor.gpu().read(Slot<Node>{plan.nodes.place, nodes});
  expect_valid(bvh, triangles);
  const Bvh expected = build_ploc(triangles, {options.radius, options.morton_bits});
  EXPECT_TRUE(same_nodes(bvh, expected));
  EXPECT_EQ(state.round_count, expected.rounds);
}

TEST_F(DeviceProperty, EveryStageOfEveryTree) {
  for_random_scenes(300, [&](RandomScene& scene) {
    const BuildOptions options = random_options(scene.random());
    const std::uint32_t count = random_count(scene.random());
    SCOPED_TRACE(described(count, options));
    expect_right_tree(scene.triangles(count), options);
  });
}

}  // namespace
}  // namespace coppice
