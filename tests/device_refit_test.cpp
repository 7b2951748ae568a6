// Refits: kernel and twin give the same bits, the tree is valid for the triangles as they lie now, and rays
// hit what they hit in a tree that is built anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "analysis/compare.h"
#include "analysis/quality.h"
#include "analysis/validate.h"
#include "pipeline/refit.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "scene/random.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/lockstep.h"
#include "support/planted_faults.h"
#include "support/rays.h"
#include "support/refitted.h"
#include "support/wide.h"

namespace coppice {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

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

// What rays hit, as by brute force over all triangles and as in a tree that is built anew.
void expect_hits(Refitted& tree, std::span<const Triangle> triangles, std::span<const Ray> rays,
                 DeviceBuilder builder) {
  const std::vector<Hit> expected = tree.hits(rays, Walk::brute_force);
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single})
    EXPECT_EQ(compare_hits(tree.hits(rays, walk), expected).other_triangle, 0u) << tree.what();
  Refitted anew(triangles, builder, "built anew");
  EXPECT_EQ(compare_hits(anew.hits(rays, Walk::binary), expected).other_triangle, 0u) << tree.what();
}

void make_inactive(Triangle& t, std::uint32_t way) {
  float* const coordinate = &(way % 2 ? t.b : t.c)[static_cast<int>(way / 2 % 3)];
  *coordinate = way % 5 == 0 ? infinity : way % 5 == 1 ? -infinity : nan;
}

TEST_P(Refit, HitsOfManyFramesInWhichTrianglesComeAndGo) {
  const std::vector<Triangle> rest = random_triangles(700, 3, 0.2f);
  const std::vector<Ray> rays = rays_around(rest, Refitted::ray_count, 5);
  Refitted tree(rest, GetParam(), "frames");
  std::vector<Triangle> moved = rest;
  for (std::uint32_t frame = 1; frame <= 4; ++frame) {
    moved = deformed(moved, frame);
    std::vector<Triangle> triangles = moved;
    Random random(frame);
    for (Triangle& t : triangles) {
      if (random.below(4) < frame - 1) make_inactive(t, random.next());
    }
    tree.move(triangles);
    tree.expect_valid(triangles);
    EXPECT_EQ(tree.state().appeared_count, 0u);
    expect_cost(tree);
    expect_hits(tree, triangles, rays, GetParam());
  }
}

TEST_P(Refit, WithoutAnyActiveTriangleNothingIsHitNorVisited) {
  for (const std::uint32_t size : {1u, 2u, 3u, 400u}) {
    const std::vector<Triangle> rest = random_triangles(size, 8, 0.2f);
    const std::vector<Ray> rays = rays_around(rest, Refitted::ray_count, 5);
    Refitted tree(rest, GetParam(), std::to_string(size) + " inactive triangles");
    const std::vector<Node> built = tree.nodes();
    std::vector<Triangle> none = rest;
    for (std::uint32_t i = 0; i < size; ++i) make_inactive(none[i], i);
    tree.move(none);
    tree.expect_valid(none);
    for (const Node& node : tree.nodes()) EXPECT_EQ(node.box_min.x, NOTHING_BOX);
    for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single, Walk::brute_force}) {
      for (const Hit& hit : tree.hits(rays, walk)) EXPECT_EQ(hit.triangle, NO_TRIANGLE);
      if (walk == Walk::binary) {
        EXPECT_EQ(tree.steps(), 0u);
      }
    }
    EXPECT_EQ(tree.candidates(rays), std::vector<uint>(Refitted::ray_count, 0));
    expect_cost(tree);
    tree.move(rest);  // they come back
    EXPECT_TRUE(same_bits(tree.nodes(), built));
  }
}

// A subtree of nothing: rays pass it by in the binary tree, and its node has no part in any box.
TEST_P(Refit, ANodeAboveNothing) {
  const std::vector<Triangle> rest = random_triangles(2000, 11, 0.1f);
  Refitted tree(rest, GetParam(), "a node above nothing");
  const std::vector<Node> nodes = tree.nodes();
  const auto top = std::ranges::find_if(nodes, [](const Node& n) { return n.height == 6; });
  ASSERT_NE(top, nodes.end());
  std::vector<Triangle> triangles = rest;
  std::vector<uint> open = {static_cast<uint>(top - nodes.begin())};
  while (!open.empty()) {
    const Node& node = nodes[open.back()];
    open.pop_back();
    if (node.height == 0) {
      make_inactive(triangles[node.child], node.child);
    } else {
      open.insert(open.end(), {node.child, node.child + 1});
    }
  }
  tree.move(triangles);
  tree.expect_valid(triangles);
  EXPECT_EQ(tree.nodes()[top - nodes.begin()].box_max.z, -NOTHING_BOX);
  expect_hits(tree, triangles, rays_around(rest, Refitted::ray_count, 5), GetParam());
}

TEST_P(Refit, TrianglesThatHaveNoLeafAreCountedWhenTheyAppear) {
  for (const std::uint32_t size : {33u, 2500u}) {
    const std::vector<Triangle> all = random_triangles(size, 2);
    std::vector<Triangle> some = all;
    std::uint32_t absent = 0;
    for (std::uint32_t i = 3; i < size; i += 5, ++absent) make_inactive(some[i], i);
    Refitted tree(some, GetParam(), "appearing");
    tree.move(some);
    EXPECT_EQ(tree.state().appeared_count, 0u);
    tree.expect_valid(some);
    tree.move(all);
    EXPECT_EQ(tree.state().appeared_count, absent);
    std::vector<Triangle> others = some;  // the last one alone, while one with a leaf goes
    const std::uint32_t last = (size - 4) / 5 * 5 + 3;
    others[last] = all[last];
    make_inactive(others[0], 2);
    tree.move(others);
    EXPECT_EQ(tree.state().appeared_count, 1u);
  }
}

TEST_P(Refit, BoxesThatBecomeHugeAndFlat) {
  const std::vector<Triangle> rest = random_triangles(600, 4, 0.3f);
  Refitted tree(rest, GetParam(), "huge and flat");
  const auto move = [&](vec3 scale) {
    const auto moved = [&](vec3 p) { return (p - 0.6f) * scale + 0.0f; };  // no -0
    std::vector<Triangle> triangles = rest;
    for (Triangle& t : triangles) t = {moved(t.a), moved(t.b), moved(t.c)};
    tree.move(triangles);
    tree.expect_valid(triangles);
    return triangles;
  };
  for (const float huge : {3e38f, -2e38f}) {  // beyond what rays are traced in
    move(vec3(huge));
    move(vec3(1, huge, 1));
  }
  for (const vec3 scale : {vec3(1, 0, 1), vec3(0), vec3(1e15f, 0, 1), vec3(1e15f, -1e15f, 2e15f)}) {
    const std::vector<Triangle> triangles = move(scale);
    expect_hits(tree, triangles, rays_around(triangles, Refitted::ray_count, 5), GetParam());
  }
}

TEST_P(Refit, EveryHardCase) {
  for (const HardCase& hard_case : hard_cases()) {
    const std::uint32_t count = std::min(hard_case.default_triangle_count, 700u);
    const std::vector<Triangle> triangles = scene_arrays(hard_case.make(count, 1)).triangles;
    Refitted tree(triangles, GetParam(), std::string(hard_case.name));
    const std::vector<Node> built = tree.nodes();
    std::vector<Triangle> others = triangles;  // all go elsewhere, and come back
    std::ranges::reverse(others);
    tree.move(others);
    if (tree.state().appeared_count == 0) tree.expect_valid(others);
    tree.move(triangles);
    EXPECT_TRUE(same_bits(tree.nodes(), built)) << hard_case.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Builders, Refit,
                         testing::Values(DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh),
                         [](const auto& info) {
                           return std::string(device_builders()[static_cast<int>(info.param)].name).substr(4);
                         });

class RefitOfTheHost : public DeviceTest {};

// Levels beyond those with dispatches of their own, and a tree that is too high for any.
TEST_F(RefitOfTheHost, ChainsUpToTheHeightThatIsTaken) {
  for (const uint height :
       {1u, REFIT_DISPATCHED_LEVELS, REFIT_DISPATCHED_LEVELS + 1, REFIT_MAX_HEIGHT, REFIT_MAX_HEIGHT + 1}) {
    const std::vector<Node> nodes = chain_of_leaves(height + 1);
    const std::vector<Triangle> triangles = random_triangles(height + 1, height);
    for (const std::uint32_t max_turns : {0xffffffffu, 65000u}) {
      Layout layout(test_device().properties().max_block_bytes);
      const TreeSlots tree = plan_tree(layout, height + 1, nodes.size());
      const RefitPlan refit = plan_refit(layout, tree, nullptr, max_turns);
      LockstepExecutor executor(test_device(), layout);
      upload_tree(executor, tree, nodes);
      executor.upload(tree.triangles, std::span<const Triangle>(triangles));
      const auto difference = executor.run([&](Chain& chain) {
        append_refit_order(chain, tree, refit);
        append_refit(chain, tree, refit);
      });
      EXPECT_FALSE(difference) << height << ": " << difference->stage << ", " << difference->slot;
      const bool taken = height <= REFIT_MAX_HEIGHT;
      EXPECT_EQ(executor.gpu().read(tree.state)[0].error_word, taken ? 0 : ERROR_REFIT_TOO_DEEP);
      const std::vector<Node> refitted = executor.gpu().read(tree.nodes);
      if (taken) {
        EXPECT_EQ(find_fault(refitted, triangles, {.refitted = true}), std::nullopt) << height;
      } else {
        EXPECT_TRUE(same_bits(refitted, nodes));
      }
    }
  }
}

}  // namespace
}  // namespace coppice
