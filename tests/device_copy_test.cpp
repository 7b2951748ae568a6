// The copy that other kernels are measured by copies, and copies all.
#include <gtest/gtest.h>

#include "measure/copy_limit.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class DeviceCopy : public DeviceTest {};

TEST_F(DeviceCopy, SameWordsAsTheTwinInEverySize) {
  for (const std::uint64_t quads :
       {1u, COPY_GROUP, COPY_TILE - 1, COPY_TILE, COPY_TILE + 1, 5 * COPY_TILE + 7}) {
    Layout layout(test_device().properties().max_block_bytes);
    const CopyPlan plan = plan_copy(layout, quads * 32);
    ASSERT_EQ(plan.source.count, quads);
    LockstepExecutor executor(test_device(), layout);
    std::vector<uvec4> words(quads);
    for (uint i = 0; i < quads; ++i) words[i] = {i, ~i, i * 7919, 1};
    executor.upload(plan.source, std::span<const uvec4>(words));
    const auto difference = executor.run([&](Chain& chain) { append_copy(chain, plan, quads * 32); });
    EXPECT_FALSE(difference) << quads << " quads: " << difference->slot << "[" << difference->index << "]";
    EXPECT_EQ(executor.gpu().read(plan.target), words);
  }
}

TEST_F(DeviceCopy, MeasuresUpToTheSizeThatIsAskedFor) {
  const CopyLimit limit = measure_copy_limit(test_device(), 100000);
  const auto& measured = limit.measurements();
  ASSERT_EQ(measured.size(), 4u);
  EXPECT_EQ(measured[0].bytes, 4096u);
  EXPECT_EQ(measured[3].bytes, 262144u);
  for (const auto& measurement : measured) EXPECT_GT(measurement.ms, 0.0);
}

}  // namespace
}  // namespace coppice
