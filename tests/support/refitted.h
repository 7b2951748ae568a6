#pragma once

#include <gtest/gtest.h>

#include "analysis/validate.h"
#include "analysis/wide_tree.h"
#include "pipeline/refit.h"
#include "pipeline/trace_any.h"
#include "pipeline/wide_plan.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {

// A tree that is built once and then refitted, kernel by kernel beside its twin.
class Refitted {
 public:
  static constexpr std::uint32_t ray_count = 160;  // of each trace

  Refitted(std::span<const Triangle> triangles, DeviceBuilder builder, std::string what,
           bool share_scratch = true)
      : what_(std::move(what)), layout_(test_device().properties().max_block_bytes) {
    BuildOptions options;
    options.builder = builder;
    options.radius = 4;
    const std::uint32_t max_turns = test_device().properties().max_turns();
    build_ = plan_build(layout_, static_cast<std::uint32_t>(triangles.size()), options);
    wide_ = plan_wide(layout_, build_, share_scratch ? &build_ : nullptr, max_turns);
    refit_ = plan_refit(layout_, build_, share_scratch ? &build_ : nullptr, max_turns);
    any_ = plan_any_hits(layout_, ray_count);
    closest_ = {
        any_.rays, layout_.add<Hit>("hits", ray_count), layout_.add<TraceCounters>("hit_counters", 1), {}};
    boxes_ = plan_candidates(layout_, ray_count, 4);
    executor_.emplace(test_device(), layout_);
    executor_->upload(build_.triangles, triangles);
    run([&](Chain& chain) {
      append_build(chain, build_);
      append_wide(chain, build_, wide_);
      append_refit_order(chain, build_, refit_);
    });
    EXPECT_EQ(build_state().error_word, 0u) << what_;
  }

  void move(std::span<const Triangle> triangles) {
    executor_->upload(build_.triangles, triangles);
    run([&](Chain& chain) {
      append_refit(chain, build_, refit_);
      append_tree_cost(chain, build_, refit_);
      append_wide_boxes(chain, build_, wide_);
    });
    EXPECT_EQ(build_state().error_word, 0u) << what_;
  }

  // With the triangles of the last move, but for the boxes of nothing.
  void expect_valid(std::span<const Triangle> triangles) const {
    const std::vector<Node> its = nodes();
    EXPECT_EQ(find_fault(its, triangles, {.refitted = true}), std::nullopt) << what_;
    EXPECT_EQ(find_wide_fault(wide_nodes(), its, true), std::nullopt) << what_;
  }

  // What rays hit on their way through the tree as it is.
  std::vector<Hit> hits(std::span<const Ray> rays, Walk walk) {
    TraceOptions options = test_trace_options(1, 1);
    options.walk = walk;
    executor_->upload(closest_.rays, rays);
    run([&](Chain& chain) {
      append_misses(chain, closest_, ray_count);
      append_closest_hits(chain, build_, closest_, ray_count, options);
      if (walk != Walk::brute_force) append_any_hits(chain, build_, any_, ray_count, options);
    });
    EXPECT_EQ(build_state().error_word, 0u) << what_;
    const std::vector<Hit> found = executor_->gpu().read(closest_.hits);
    if (walk == Walk::brute_force) return found;
    const std::vector<uint> any = executor_->gpu().read(any_.any_hits);
    for (std::size_t i = 0; i < ray_count; ++i)
      EXPECT_EQ(any[i] != 0, found[i].triangle != NO_TRIANGLE) << what_ << ", ray " << i;
    return found;
  }

  // How many leaves' boxes each ray meets.
  std::vector<uint> candidates(std::span<const Ray> rays) {
    executor_->upload(boxes_.rays, rays);
    run([&](Chain& chain) { append_candidates(chain, build_, boxes_, ray_count, test_trace_options(1, 1)); });
    return executor_->gpu().read(boxes_.candidate_counts);
  }

  // Pairs or nodes that the last trace of closest hits visited.
  std::uint64_t steps() const { return counts_of(executor_->gpu().read(closest_.counters)[0]).steps; }

  std::vector<Node> nodes() const {
    const std::uint64_t active = build_state().active_count;
    return executor_->gpu().read(Slot<Node>{build_.nodes.place, active == 0 ? 0 : 2 * active - 1});
  }
  std::vector<WideNode> wide_nodes() const {
    const WideCounts counts = executor_->gpu().read(build_.wide_counts)[0];
    return executor_->gpu().read(Slot<WideNode>{build_.wide_nodes.place, counts.node_count});
  }
  BuildState build_state() const { return executor_->gpu().read(build_.state)[0]; }
  RefitState state() const { return executor_->gpu().read(refit_.state)[0]; }
  std::string_view what() const { return what_; }

 private:
  void run(const std::function<void(Chain&)>& append) {
    const auto difference = executor_->run(append);
    EXPECT_FALSE(difference) << what_ << ": stage " << difference->stage << ", " << difference->slot << "["
                             << difference->index << "]\ncpu " << difference->cpu << "\ngpu "
                             << difference->gpu;
  }

  std::string what_;
  Layout layout_;
  BuildPlan build_;
  WidePlan wide_;
  RefitPlan refit_;
  AnyHitSlots any_;
  RaySlots closest_;
  CandidateSlots boxes_;
  std::optional<LockstepExecutor> executor_;
};

}  // namespace coppice
