// The wide tree: kernel and twin give the same bits, and what they give is the tree that it was made from.
#include <gtest/gtest.h>

#include "apps/frame.h"
#include "pipeline/wide.h"
#include "scene/hard_cases.h"
#include "stages/lockstep_executor.h"
#include "support/lockstep.h"

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
  }
};

TEST_P(WideTree, SizesUpTo300InLockstep) {
  for (std::uint32_t size = 0; size <= 300; ++size)
    expect_in_lockstep(random_triangles(size, size), std::to_string(size) + " triangles");
}

INSTANTIATE_TEST_SUITE_P(Builders, WideTree,
                         testing::Values(DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh),
                         [](const auto& info) {
                           return std::string(device_builders()[static_cast<int>(info.param)].name).substr(4);
                         });

}  // namespace
}  // namespace coppice
