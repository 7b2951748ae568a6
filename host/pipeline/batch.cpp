#include "pipeline/batch.h"

#include <algorithm>

#include "stages/stages.h"

namespace coppice {

BatchPlan plan_batch(Layout& layout, std::uint32_t primitive_count, std::uint32_t range_count,
                     const BuildOptions& options, PrimitiveKind kind) {
  check_build(primitive_count, options);
  BatchPlan plan;
  plan.options = options;
  plan.primitives = plan_primitives(layout, primitive_count, kind);
  plan.ranges = layout.add<BatchRange>("ranges", range_count, Memory::source);
  plan.nodes = layout.add<Node>("nodes", 2 * std::uint64_t{primitive_count}, Memory::tree);
  plan.trees = layout.add<BatchTree>("trees", range_count, Memory::tree);
  plan.state = layout.add<BuildState>("batch_state", 1, Memory::tree);
  return plan;
}

void append_batch(Chain& chain, const BatchPlan& plan, const BuildInput& input, UintBuffer ranges_at) {
  const auto range_count = static_cast<std::uint32_t>(plan.ranges.count);
  const std::uint32_t workgroups = counted_groups(range_count, 1, ranges_at).x;
  const std::uint32_t rows = std::max(groups_of(workgroups, 65535).x, 1u);
  chain.clear(plan.primitives.state);
  chain.clear(plan.state);
  append_primitives(chain, plan.primitives, input);
  chain.run(stages::batch_build,
            {chain.at(plan.ranges), chain.at(plan.primitives.boxes), chain.at(plan.nodes),
             chain.at(plan.trees), chain.at(plan.state), ranges_at, input.count_at, range_count,
             plan.primitives.count, plan.options.morton_bits / 30, plan.options.radius},
            groups_of(workgroups, rows, rows), {plan.options.radius});
}

}  // namespace coppice
