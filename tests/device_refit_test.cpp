// Refits: kernel and twin give the same bits, the tree is valid for the triangles as they lie now, and rays
// hit what they hit in a tree that is built anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "analysis/quality.h"
#include "analysis/validate.h"
#include "analysis/wide_tree.h"
#include "pipeline/refit.h"
#include "pipeline/wide_plan.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "scene/random.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/lockstep.h"
#include "support/wide.h"

namespace coppice {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();


// A tree that is built once and then refitted, kernel by kernel beside its twin.
class Refitted {
 public:
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
  std::optional<LockstepExecutor> executor_;
};

bool same_bits(const auto& a, const auto& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

// Every corner goes somewhere else: some a little, some far.
std::vector<Triangle> deformed(std::vector<Triangle> triangles, std::uint64_t seed) {
  Random random(seed);
  for (Triangle& t : triangles) {
    for (vec3* const corner : {&t.a, &t.b, &t.c}) *corner += random.in_cube() * 0.05f;
    if (random.next() % 16 == 0) t.b *= 7.0f;
  }
  return triangles;
}

void expect_topology_kept(const std::vector<Node>& before, const std::vector<Node>& after) {
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(before[i].child, after[i].child) << i;
    ASSERT_EQ(before[i].height, after[i].height) << i;
  }
}

void expect_cost(const Refitted& tree) {
  const std::vector<Node> nodes = tree.nodes();
  const double expected = measure_quality(nodes).sah;
  const auto leaves = static_cast<std::uint32_t>((nodes.size() + 1) / 2);
  EXPECT_NEAR(sah_cost(tree.state(), leaves), expected, expected * sah_cost_error(leaves)) << tree.what();
}

class Refit : public DeviceTest, public testing::WithParamInterface<DeviceBuilder> {
 protected:
  // Two frames where nothing moved, or all of it did.
  static void expect_refits(const std::vector<Triangle>& triangles, const std::string& what,
                            bool share_scratch = true) {
    Refitted tree(triangles, GetParam(), what, share_scratch);
    const std::vector<Node> built = tree.nodes();
    const std::vector<WideNode> widened = tree.wide_nodes();
    tree.move(triangles);
    EXPECT_TRUE(same_bits(tree.nodes(), built)) << what << ": not the boxes of the build";
    EXPECT_TRUE(same_bits(tree.wide_nodes(), widened)) << what << ": not the wide boxes of the build";
    expect_cost(tree);
    const std::vector<Triangle> moved = deformed(triangles, triangles.size());
    tree.move(moved);
    tree.expect_valid(moved);
    expect_topology_kept(built, tree.nodes());
    expect_cost(tree);
  }
};

TEST_P(Refit, SizesUpTo300) {
  for (std::uint32_t size = 0; size <= 300; size += size < 20 ? 1 : 7)
    expect_refits(random_triangles(size, size), std::to_string(size) + " triangles");
}

TEST_P(Refit, Thousands) {
  for (const std::uint32_t size : {4096u, 20000u})
    expect_refits(random_triangles(size, size), std::to_string(size) + " triangles");
  expect_refits(random_triangles(5000, 1), "scratch of its own", false);
}

INSTANTIATE_TEST_SUITE_P(Builders, Refit,
                         testing::Values(DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh),
                         [](const auto& info) {
                           return std::string(device_builders()[static_cast<int>(info.param)].name).substr(4);
                         });

}  // namespace
}  // namespace coppice
