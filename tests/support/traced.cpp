#include "support/traced.h"

#include "analysis/compare.h"
#include "pipeline/wide_plan.h"
#include "stages/lockstep_executor.h"

namespace coppice {

namespace {

RayFilter plan_filter(Layout& layout, const RaysToTrace& input) {
  return {layout.add<uint>("primitive_flags", input.primitive_flags.size()),
          layout.add<uint>("ray_masks", input.ray_masks.size()),
          layout.add<uint>("count", input.count ? 1 : 0), input.ray_mask};
}

template <class Executor>
void upload_filter(Executor& executor, const RayFilter& filter, const RaysToTrace& input) {
  executor.upload(filter.primitive_flags, std::span<const uint>(input.primitive_flags));
  executor.upload(filter.ray_masks, std::span<const uint>(input.ray_masks));
  if (input.count) executor.upload(filter.count_at, std::span<const uint>(&*input.count, 1));
}

template <class Executor>
void upload_nodes(Executor& executor, const TreeSlots& tree, const RaysToTrace& input) {
  BuildState state{};
  state.active_count = static_cast<uint>((input.nodes.size() + 1) / 2);
  executor.upload(tree.nodes, input.nodes);
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
}

void expect_no_difference(const std::optional<Difference>& difference) {
  EXPECT_FALSE(difference) << "stage " << difference->stage << ", " << difference->slot << "["
                           << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                           << difference->gpu;
}

struct TracedSlots {
  TreeSlots tree;
  WidePlan wide;
  AnyHitSlots any;
  RaySlots closest;
};

TracedSlots plan_traced(Layout& layout, const RaysToTrace& input) {
  const auto ray_count = static_cast<std::uint32_t>(input.rays.size());
  TracedSlots slots;
  slots.tree = plan_tree(layout, static_cast<std::uint32_t>(input.triangles.size()), input.nodes.size());
  slots.wide = plan_wide(layout, slots.tree);
  slots.any = plan_any_hits(layout, ray_count);
  slots.any.filter = plan_filter(layout, input);
  slots.closest = {slots.any.rays, layout.add<Hit>("hits", ray_count),
                   layout.add<TraceCounters>("hit_counters", 1), slots.any.filter};
  return slots;
}

template <class Executor>
void upload_traced(Executor& executor, const TracedSlots& slots, const RaysToTrace& input) {
  std::vector<Hit> hits;
  const uint counted = std::min(input.count.value_or(NO_TRIANGLE), static_cast<uint>(input.rays.size()));
  for (const Ray& ray : input.rays)
    hits.push_back({ray.t_max, hits.size() < counted ? NO_TRIANGLE : UNTOUCHED, 0, 0});
  const std::vector<uint> words(input.rays.size(), UNTOUCHED);
  upload_nodes(executor, slots.tree, input);
  upload_filter(executor, slots.any.filter, input);
  executor.upload(slots.tree.triangles, input.triangles);
  executor.upload(slots.any.rays, input.rays);
  executor.upload(slots.any.any_hits, std::span<const uint>(words));
  executor.upload(slots.closest.hits, std::span<const Hit>(hits));
}

void append_traces(Chain& chain, const TracedSlots& slots, const TraceOptions& options) {
  const auto ray_count = static_cast<std::uint32_t>(slots.any.rays.count);
  if (is_wide(options.walk)) append_wide(chain, slots.tree, slots.wide);
  append_closest_hits(chain, slots.tree, slots.closest, ray_count, options);
  append_any_hits(chain, slots.tree, slots.any, ray_count, options);
}

template <class Executor>
TracedBoth read_traced(const Executor& executor, const TracedSlots& slots) {
  return {executor.read(slots.closest.hits), executor.read(slots.any.any_hits),
          executor.read(slots.closest.counters)[0], executor.read(slots.any.counters)[0],
          executor.read(slots.tree.state)[0].error_word};
}

}  // namespace

TracedBoth trace_in_lockstep(const RaysToTrace& input, const TraceOptions& options, Device& device) {
  Layout layout(device.properties().max_block_bytes);
  const TracedSlots slots = plan_traced(layout, input);
  LockstepExecutor executor(device, layout);
  upload_traced(executor, slots, input);
  expect_no_difference(executor.run([&](Chain& chain) { append_traces(chain, slots, options); }));
  return read_traced(executor.gpu(), slots);
}

TracedBoth trace_on_both(const RaysToTrace& input, const TraceOptions& options) {
  Layout layout(test_device().properties().max_block_bytes);
  const TracedSlots slots = plan_traced(layout, input);
  GpuExecutor gpu(test_device(), layout);
  CpuExecutor cpu(layout);
  upload_traced(gpu, slots, input);
  upload_traced(cpu, slots, input);
  Chain gpu_chain = gpu.chain(), cpu_chain = cpu.chain();
  append_traces(gpu_chain, slots, options);
  append_traces(cpu_chain, slots, options);
  gpu.record(gpu_chain.steps()).submit_and_wait(submit_limit_seconds);
  cpu.run(cpu_chain.steps());
  const TracedBoth traced = read_traced(gpu, slots), expected = read_traced(cpu, slots);
  if (rounds_like_the_host(test_device().properties())) {
    EXPECT_EQ(compare_hits(traced.hits, expected.hits).count, 0u);
    EXPECT_EQ(traced.any_hits, expected.any_hits);
  }
  EXPECT_EQ(traced.error_word, expected.error_word);
  return traced;
}

TracedCandidates candidates_in_lockstep(const RaysToTrace& input, std::uint32_t capacity,
                                        const TraceOptions& options, Device& device) {
  Layout layout(device.properties().max_block_bytes);
  const auto ray_count = static_cast<std::uint32_t>(input.rays.size());
  const TreeSlots tree = plan_tree(layout, 0, input.nodes.size());
  CandidateSlots slots = plan_candidates(layout, ray_count, capacity);
  slots.filter = plan_filter(layout, input);
  LockstepExecutor executor(device, layout);
  upload_nodes(executor, tree, input);
  upload_filter(executor, slots.filter, input);
  executor.upload(slots.rays, input.rays);
  const std::vector<BoxCandidate> none(slots.candidates.count, {UNTOUCHED, 0});
  executor.upload(slots.candidates, std::span<const BoxCandidate>(none));
  executor.upload(slots.candidate_counts, std::span<const uint>(std::vector<uint>(ray_count, UNTOUCHED)));
  expect_no_difference(
      executor.run([&](Chain& chain) { append_candidates(chain, tree, slots, ray_count, options); }));
  const GpuExecutor& gpu = executor.gpu();
  return {gpu.read(slots.candidates), gpu.read(slots.candidate_counts), gpu.read(slots.counters)[0],
          gpu.read(tree.state)[0].error_word};
}

}  // namespace coppice
