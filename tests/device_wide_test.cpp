// The wide tree: kernel and twin give the same bits, and what they give is the tree that it was made from.
#include <gtest/gtest.h>

#include "analysis/wide_tree.h"
#include "builders/ploc.h"
#include "builders/registry.h"
#include "pipeline/wide_plan.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/lockstep.h"
#include "support/planted_faults.h"
#include "support/wide.h"

namespace coppice {
namespace {

class WideTree : public DeviceTest, public testing::WithParamInterface<DeviceBuilder> {
 protected:
  static void expect_in_lockstep(std::span<const Triangle> triangles, const std::string& what) {
    BuildOptions options;
    options.builder = GetParam();
    options.radius = 4;
    Layout layout(test_device().properties().max_block_bytes);
    BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
    const WidePlan wide = plan_wide(layout, plan, &plan);
    LockstepExecutor executor(test_device(), layout);
    executor.upload(plan.triangles, triangles);
    const auto difference = executor.run([&](Chain& chain) {
      append_build(chain, plan);
      append_wide(chain, plan, wide);
    });
    ASSERT_FALSE(difference) << what << ": stage " << difference->stage << ", " << difference->slot << "["
                             << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                             << difference->gpu;
    const BuildState state = executor.gpu().read(plan.state)[0];
    EXPECT_EQ(state.error_word, 0u) << what;
    const WideCounts counts = executor.gpu().read(plan.wide_counts)[0];
    const auto wide_nodes = executor.gpu().read(Slot<WideNode>{plan.wide_nodes.place, counts.node_count});
    const std::uint64_t nodes = state.active_count == 0 ? 0 : 2 * std::uint64_t{state.active_count} - 1;
    EXPECT_EQ(find_wide_fault(wide_nodes, executor.gpu().read(Slot<Node>{plan.nodes.place, nodes})),
              std::nullopt)
        << what;
  }
};

TEST_P(WideTree, SizesUpTo300InLockstep) {
  for (std::uint32_t size = 0; size <= 300; ++size)
    expect_in_lockstep(random_triangles(size, size), std::to_string(size) + " triangles");
}

TEST_P(WideTree, PowersOfTwoAndTheirNeighboursInLockstep) {
  for (std::uint32_t exponent = 9; exponent <= 16; ++exponent) {
    for (const std::uint32_t size : {(1u << exponent) - 1, 1u << exponent, (1u << exponent) + 1})
      expect_in_lockstep(random_triangles(size, size), std::to_string(size) + " triangles");
  }
}

TEST_P(WideTree, EveryHardCaseInLockstep) {
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 20000u);
    expect_in_lockstep(scene_arrays(hard_case.make(count, 1)).triangles, std::string(hard_case.name));
  }
}

// Levels of more than one block of tiles.
TEST_P(WideTree, HalfAMillionTrianglesInLockstep) {
  expect_in_lockstep(random_triangles(500000, 4, 0.004f), "half a million");
}

class WideTreeOfTheHost : public DeviceTest {
 protected:
  static void expect_in_lockstep(std::span<const Node> nodes, uint error_word, const std::string& what) {
    Layout layout(test_device().properties().max_block_bytes);
    const UploadedTree uploaded = plan_uploaded(layout, nodes, test_device().properties().max_turns());
    LockstepExecutor executor(test_device(), layout);
    upload_tree(executor, uploaded.tree, nodes);
    const auto difference =
        executor.run([&](Chain& chain) { append_wide(chain, uploaded.tree, uploaded.wide); });
    EXPECT_FALSE(difference) << what << ": " << difference->stage << ", " << difference->slot;
    EXPECT_EQ(executor.gpu().read(uploaded.tree.state)[0].error_word, error_word) << what;
    const WideCounts counts = executor.gpu().read(uploaded.tree.wide_counts)[0];
    EXPECT_EQ(counts.node_count == 0, error_word != 0) << what;
    if (error_word != 0) return;
    const auto wide = executor.gpu().read(Slot<WideNode>{uploaded.tree.wide_nodes.place, counts.node_count});
    EXPECT_EQ(find_wide_fault(wide, nodes), std::nullopt) << what;
    EXPECT_EQ(measure_wide_quality(wide).levels, counts.level_count) << what;
  }
};

TEST_F(WideTreeOfTheHost, OfEveryBuilderThatSplitsNoTriangle) {
  const std::vector<Triangle> triangles = random_triangles(3000, 9);
  for (const CpuBuilder& builder : cpu_builders()) {
    const Bvh bvh = builder.build(triangles, {});
    if (bvh.nodes.size() == 2 * triangles.size() - 1)
      expect_in_lockstep(bvh.nodes, 0, std::string(builder.name));
  }
}

TEST_F(WideTreeOfTheHost, ChainsUpToTheHeightThatIsTaken) {
  for (const uint height : {1u, 2u, 7u, 8u, 255u, WIDE_MAX_HEIGHT})
    expect_in_lockstep(chain_of_leaves(height + 1), 0, std::to_string(height));
  expect_in_lockstep(chain_of_leaves(WIDE_MAX_HEIGHT + 2), ERROR_WIDE_TOO_DEEP, "one too high");
}

// Most nodes are in levels that have no dispatch of their own, but for drivers that end long loops.
TEST_F(WideTreeOfTheHost, ManyNodesBelowTheLevelsThatAreDispatched) {
  const Bvh bvh = build_ploc(random_triangles(150000, 5, 0.01f), {});
  const std::vector<Node> nodes = below_a_chain(bvh.nodes, 230);
  expect_in_lockstep(nodes, 0, "below a chain");
  EXPECT_GT(measure_wide_quality(widen_by_twins(nodes)).levels, WIDE_DISPATCHED_LEVELS + 4);
}

// --- Planted faults: a twin that does its work and one thing wrong.

struct WideFault {
  const StageDeclaration* stage;
  const char* slot;
  void (*twin)(const void* args);
};

constexpr auto one_size_more = [](const void* args) {
  const auto a = args_of<WideSizesArgs>(args);
  twins::wide_sizes(a);
  ++a.sizes[a.levels[a.level].first];
};

std::vector<WideFault> wide_faults() {
  return {{&stages::wide_root, "clusters_even",
           [](const void* args) {
             twins::wide_root(args_of<WideCollapseArgs>(args));
             args_of<WideCollapseArgs>(args).children[0] ^= 1;
           }},
          {&stages::wide_collapse, "wide_levels",
           [](const void* args) {
             const auto a = args_of<WideCollapseArgs>(args);
             twins::wide_collapse(a);
             ++a.levels[a.level + 1].count;
           }},
          {&stages::wide_sizes, "boxes", one_size_more},
          {&stages::wide_quantise, "wide_nodes", [](const void* args) {
             const auto a = args_of<WideQuantiseArgs>(args);
             twins::wide_quantise(a);
             a.wide_nodes[a.counts[0].node_count - 1].planes[0] ^= 1u << 8;
           }}};
}

TEST_F(WideTreeOfTheHost, NamesAPlantedFaultByStageAndSlot) {
  for (const WideFault& fault : wide_faults()) {
    StageDeclaration faulty = *fault.stage;
    faulty.twin = fault.twin;
    Layout layout(test_device().properties().max_block_bytes);
    BuildPlan plan = plan_build(layout, 3000, {});
    const WidePlan wide = plan_wide(layout, plan, &plan);
    LockstepExecutor executor(test_device(), layout);
    executor.upload(plan.triangles, std::span<const Triangle>(random_triangles(3000, 1)));
    const auto difference = executor.run([&](Chain& chain) {
      append_build(chain, plan);
      append_wide(chain, plan, wide);
      for (Step& step : chain.steps()) {
        if (stage_of(step) == fault.stage) dispatch_of(step)->stage = &faulty;
      }
    });
    ASSERT_TRUE(difference) << fault.stage->name << ": not noticed";
    EXPECT_EQ(difference->stage, fault.stage->name);
    EXPECT_EQ(difference->slot, fault.slot) << "in " << fault.stage->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Builders, WideTree,
                         testing::Values(DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh),
                         [](const auto& info) {
                           return std::string(device_builders()[static_cast<int>(info.param)].name).substr(4);
                         });

}  // namespace
}  // namespace coppice
