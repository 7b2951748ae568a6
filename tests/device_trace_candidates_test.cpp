// The candidates of a ray are those whose boxes it meets, in order, whatever the tree over them; by kernel
// and twin alike, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "analysis/hard_rays.h"
#include "builders/lbvh.h"
#include "builders/ploc.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "stages/gpu_executor.h"
#include "support/floor.h"
#include "support/traced.h"

namespace coppice {
namespace {

class TraceCandidates : public DeviceTest {
 protected:
  static TracedCandidates trace(const RaysToTrace& input, std::uint32_t capacity) {
    return candidates_in_lockstep(input, capacity, test_trace_options(1, 1));
  }
};

using Candidates = std::vector<BoxCandidate>;

bool same_bits(const Candidates& a, const Candidates& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(BoxCandidate)) == 0;
}

// Where a line is between the planes of a box grown by `margin`, in double.
struct Passage {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
};

Passage passage_of(const Node& box, const Ray& ray, double margin) {
  Passage passage;
  for (int axis = 0; axis < 3; ++axis) {
    const double below = double{box.box_min[axis]} - margin - ray.origin[axis];
    const double above = double{box.box_max[axis]} + margin - ray.origin[axis];
    if (ray.direction[axis] == 0) {
      if (below > 0 || above < 0) passage.leave = -INFINITE;
      continue;
    }
    const double one = below / ray.direction[axis], other = above / ray.direction[axis];
    passage.enter = std::max(passage.enter, std::min(one, other));
    passage.leave = std::min(passage.leave, std::max(one, other));
  }
  return passage;
}

// By double, with room for what rounds in float. Returns how many boxes are met for sure.
std::size_t expect_right(std::span<const Node> nodes, std::span<const Ray> rays, std::uint32_t capacity,
                         const TracedCandidates& traced) {
  std::size_t met_for_sure = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    std::vector<bool> listed(nodes.size());
    float last = -INFINITE;
    for (std::size_t k = 0; k < traced.counts[i]; ++k) {
      const BoxCandidate& candidate = traced.candidates[i * capacity + k];
      listed[candidate.primitive] = true;
      EXPECT_GE(candidate.t_enter, last);
      EXPECT_GE(candidate.t_enter, ray.t_min);
      EXPECT_LE(candidate.t_enter, ray.t_max);
      last = candidate.t_enter;
    }
    for (const Node& node : nodes) {
      if (node.height != 0) continue;
      const double room = 1e-5;  // of a scene of size 1, seen from near
      const Passage inner = passage_of(node, ray, -0.0), outer = passage_of(node, ray, room);
      const double begin = ray.t_min, end = ray.t_max;
      const bool surely = inner.enter <= inner.leave && inner.leave >= begin && inner.enter <= end;
      const bool surely_not = outer.enter > outer.leave || outer.leave < begin || outer.enter > end;
      met_for_sure += surely;
      if (surely) {
        EXPECT_TRUE(listed[node.child]) << "ray " << i << ", box " << node.child;
      }
      if (surely_not) {
        EXPECT_FALSE(listed[node.child]) << "ray " << i << ", box " << node.child;
      }
    }
  }
  return met_for_sure;
}

TEST_F(TraceCandidates, AreTheBoxesThatRaysMeet) {
  const std::vector<Triangle> triangles = random_triangles(300, 3, 0.3f);
  const Bvh bvh = build_ploc(triangles, {});
  std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 300, 4);
  const std::vector<Ray> along = hard_rays(RayKind::AXIS_PARALLEL, triangles, {}, 200, 4);
  rays.insert(rays.end(), along.begin(), along.end());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % 3 == 0) rays[i].t_max = 0.01f * static_cast<float>(i);
    if (i % 4 == 0) rays[i].t_min = -0.5f;
  }
  const TracedCandidates traced = trace({.nodes = bvh.nodes, .triangles = {}, .rays = rays}, 300);
  EXPECT_EQ(traced.error_word, 0u);
  EXPECT_GT(expect_right(bvh.nodes, rays, 300, traced), 2000u);
}

// Whatever tree stands over the leaves, and whatever the capacity: the list is cut, and the count is of all.
TEST_F(TraceCandidates, DependOnNeitherTreeNorCapacity) {
  for (const std::string_view name : {"planar-grid", "coincident-and-random", "nested", "shrinking-gaps"}) {
    const std::vector<Triangle> triangles =
        scene_arrays(find_hard_case(std::string(name))->make(200, 1)).triangles;
    const Bvh ploc = build_ploc(triangles, {}), lbvh = build_lbvh(triangles, {});
    std::vector<Ray> rays;
    for (const RayKindName& kind : ray_kinds()) {
      const std::vector<Ray> more = hard_rays(kind.kind, triangles, ploc.nodes, 20, 1);
      rays.insert(rays.end(), more.begin(), more.end());
    }
    constexpr std::uint32_t all = 256;
    const TracedCandidates whole = trace({.nodes = ploc.nodes, .triangles = {}, .rays = rays}, all);
    EXPECT_TRUE(same_bits(trace({.nodes = lbvh.nodes, .triangles = {}, .rays = rays}, all).candidates,
                          whole.candidates))
        << name;
    for (const std::uint32_t capacity : {0u, 1u, 3u, 8u}) {
      const TracedCandidates cut = trace({.nodes = ploc.nodes, .triangles = {}, .rays = rays}, capacity);
      EXPECT_EQ(cut.counts, whole.counts) << name;
      Candidates expected;
      for (std::size_t i = 0; i < rays.size(); ++i)
        expected.insert(expected.end(), &whole.candidates[i * all], &whole.candidates[i * all] + capacity);
      EXPECT_TRUE(same_bits(cut.candidates, expected)) << name << ", " << capacity;
    }
  }
}

TEST_F(TraceCandidates, OfEqualBoxesTheSmallestPrimitiveComesFirst) {
  const std::vector<Triangle> triangles(100, FLOOR);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays(10, down_at(0.25f, 0.25f));
  const TracedCandidates traced = trace({.nodes = bvh.nodes, .triangles = {}, .rays = rays}, 7);
  EXPECT_EQ(traced.counts, std::vector<uint>(10, 100u));
  for (std::size_t k = 0; k < traced.candidates.size(); ++k) EXPECT_EQ(traced.candidates[k].primitive, k % 7);
}

TEST_F(TraceCandidates, UnsoundRaysAndNoTreeHaveNone) {
  const std::vector<Triangle> triangles = {FLOOR};
  const Bvh bvh = build_ploc(triangles, {});
  const vec3 above(0.25f, 0.25f, 1), down(0, 0, -1);
  const std::vector<Ray> rays = {{vec3(NOT_A_NUMBER), 0, down, INFINITE},
                                 {above, 0, vec3(0), INFINITE},
                                 {above, 0, vec3(0, INFINITE, 0), INFINITE},
                                 {above, 2, down, 1},
                                 {above * vec3(1, 1, 8), 0, down * 0x1p-126f, INFINITE},
                                 {above, 0, down, INFINITE}};
  const TracedCandidates traced = trace({.nodes = bvh.nodes, .triangles = {}, .rays = rays}, 2);
  EXPECT_EQ(traced.counts, (std::vector<uint>{0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(traced.candidates[10].primitive, 0u);
  EXPECT_EQ(traced.candidates[11].primitive, UNTOUCHED);
  const TracedCandidates none = trace({.nodes = {}, .triangles = {}, .rays = rays}, 2);
  EXPECT_EQ(none.counts, std::vector<uint>(6, 0u));
  EXPECT_EQ(trace({.nodes = bvh.nodes, .triangles = {}, .rays = {}}, 2).counts.size(), 0u);
}

TEST_F(TraceCandidates, KeepToMasksAndToACountOnTheDevice) {
  const std::vector<Triangle> triangles = random_triangles(500, 3, 0.3f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 200, 4);
  std::mt19937 random(1);
  std::vector<uint> flags(triangles.size()), masks(rays.size());
  for (uint& word : flags) word = random() % 512;
  for (uint& word : masks) word = random() % 256;
  constexpr std::uint32_t capacity = 500;
  const TracedCandidates all = trace({.nodes = bvh.nodes, .triangles = {}, .rays = rays}, capacity);
  for (const uint count : {0u, 1u, 64u, 65u, 199u, 200u, 201u, 0xffffffffu}) {
    const TracedCandidates some = trace({.nodes = bvh.nodes,
                                         .triangles = {},
                                         .rays = rays,
                                         .primitive_flags = flags,
                                         .ray_masks = masks,
                                         .ray_mask = 0x5f,
                                         .count = count},
                                        capacity);
    Candidates expected(all.candidates.size(), {UNTOUCHED, 0});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::size_t kept = 0;
      for (std::size_t k = 0; i < count && k < all.counts[i]; ++k) {
        const BoxCandidate& candidate = all.candidates[i * capacity + k];
        if ((flags[candidate.primitive] & masks[i] & 0x5f) != 0) expected[i * capacity + kept++] = candidate;
      }
      EXPECT_EQ(some.counts[i], i < count ? kept : UNTOUCHED) << count << ", ray " << i;
    }
    EXPECT_TRUE(same_bits(some.candidates, expected)) << count;
    EXPECT_EQ(some.counters.rays.x, std::min(count, 200u));
  }
}

TEST_F(TraceCandidates, ATreeDeeperThanTheStackIsRefusedAndNothingIsMet) {
  const std::vector<Triangle> triangles = random_triangles(1000, 3, 0.5f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 100, 4);
  const RaysToTrace input{.nodes = bvh.nodes, .triangles = {}, .rays = rays};
  TraceOptions options = test_trace_options(1, 1);
  options.stack_entries = bvh.nodes[0].height;
  EXPECT_EQ(candidates_in_lockstep(input, 4, options).error_word, 0u);
  --options.stack_entries;
  const TracedCandidates refused = candidates_in_lockstep(input, 4, options);
  EXPECT_EQ(refused.error_word, ERROR_TREE_TOO_DEEP);
  EXPECT_EQ(refused.counts, std::vector<uint>(100, 0));
}

TEST_F(TraceCandidates, TooFewTurnsAreReportedByName) {
  const std::vector<Triangle> triangles = random_triangles(500, 3, 0.5f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 100, 4);
  Layout layout(test_device().properties().max_block_bytes);
  const TreeSlots tree = plan_tree(layout, 0, bvh.nodes.size());
  const CandidateSlots slots = plan_candidates(layout, 100, 4);
  GpuExecutor executor(test_device(), layout);
  BuildState state{};
  state.active_count = 500;
  executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
  executor.upload(slots.rays, std::span<const Ray>(rays));
  TraceOptions few = test_trace_options(1, 1);
  few.max_turns = 3;
  Chain chain = executor.chain();
  append_candidates(chain, tree, slots, 100, few);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(executor.read(tree.state)[0].error_word, ERROR_TRACE_STEPS);
}

TEST_F(TraceCandidates, SlotsThatAreTooSmallAreRefused) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 1, 1);
  CandidateSlots slots = plan_candidates(layout, 10, 4);
  const std::uint64_t address[] = {0};
  Chain chain(address);
  const TraceOptions options = test_trace_options(1, 1);
  EXPECT_THROW(append_candidates(chain, tree, slots, 11, options), LayoutError);
  slots.capacity = 5;
  EXPECT_THROW(append_candidates(chain, tree, slots, 10, options), LayoutError);
  slots.capacity = 0x80000000;
  EXPECT_THROW(append_candidates(chain, tree, slots, 10, options), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
