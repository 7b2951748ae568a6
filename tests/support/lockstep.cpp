#include "support/lockstep.h"

#include "scene/hard_cases.h"

namespace coppice {

std::optional<Difference> build_in_lockstep(std::span<const Triangle> triangles, const BuildOptions& options,
                                            const Plant& plant) {
  Layout layout(test_device().properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
  LockstepExecutor executor(test_device(), layout);
  executor.upload(plan.triangles, triangles);
  const auto difference = executor.run([&](Chain& chain) {
    append_build(chain, plan);
    if (plant) plant(chain.steps());
  });
  EXPECT_EQ(executor.cpu().read(plan.state)[0].error_word, 0u);
  return difference;
}

void expect_build_in_lockstep(std::span<const Triangle> triangles, const BuildOptions& options,
                              const std::string& what) {
  const auto difference = build_in_lockstep(triangles, options);
  EXPECT_FALSE(difference) << what << ": stage " << difference->stage << ", " << difference->slot << "["
                           << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                           << difference->gpu;
}

std::vector<std::string_view> hard_case_names() {
  std::vector<std::string_view> names;
  for (const HardCase& hard_case : hard_cases()) names.push_back(hard_case.name);
  return names;
}

}  // namespace coppice
