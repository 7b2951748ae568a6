// A shader that is none of Coppice's finds with traverse.glsl, included as it is installed, what Coppice's
// kernels find, bit for bit.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "analysis/compare.h"
#include "analysis/hard_rays.h"
#include "builders/ploc.h"
#include "pipeline/wide_plan.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "support/lockstep.h"
#include "support/traced.h"

namespace coppice {
namespace {

class Traverse : public DeviceTest {};

// Of tests/consumer/rays.comp.
struct ConsumerRaysArgs {
  Address<Node> nodes;
  Address<Triangle> triangles;
  Address<BuildState> state;
  Address<uint> primitive_flags;
  Address<WideNode> wide_nodes;
  Address<WideCounts> wide_counts;
  Address<Ray> rays;
  Address<Hit> hits;
  Address<uint> any_hits;
  uint ray_count, mask;
};

std::vector<std::uint32_t> read_shader(const std::string& name) {
  std::ifstream file(std::string(COPPICE_CONSUMER_SHADERS "/") + name + ".spv", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  return words;
}

struct ConsumerFound {
  std::vector<Hit> hits;
  std::vector<uint> any_hits;
};

ConsumerFound trace_by_consumer(const RaysToTrace& input) {
  static const std::vector<std::uint32_t> shader = read_shader("rays");
  const Stage<ConsumerRaysArgs, NoConstants> stage{
      {"consumer_rays", shader, nullptr, nullptr, {}, address_args_of<ConsumerRaysArgs>}};
  const auto ray_count = static_cast<std::uint32_t>(input.rays.size());
  Layout layout(test_device().properties().max_block_bytes);
  TreeSlots tree = plan_tree(layout, static_cast<std::uint32_t>(input.triangles.size()), input.nodes.size());
  const WidePlan wide = plan_wide(layout, tree);
  const auto flags = layout.add<uint>("flags", input.primitive_flags.size());
  const auto rays = layout.add<Ray>("rays", ray_count);
  const auto hits = layout.add<Hit>("hits", 2 * ray_count);
  const auto any_hits = layout.add<uint>("any_hits", 2 * ray_count);
  GpuExecutor executor(test_device(), layout);
  BuildState state{};
  state.active_count = static_cast<uint>((input.nodes.size() + 1) / 2);
  executor.upload(tree.nodes, input.nodes);
  executor.upload(tree.triangles, input.triangles);
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
  executor.upload(flags, std::span<const uint>(input.primitive_flags));
  executor.upload(rays, input.rays);
  Chain chain = executor.chain();
  append_wide(chain, tree, wide);
  chain.run(stage,
            {chain.at(tree.nodes), chain.at(tree.triangles), chain.at(tree.state),
             address_or_null(chain, flags), chain.at(tree.wide_nodes), chain.at(tree.wide_counts),
             chain.at(rays), chain.at(hits), chain.at(any_hits), ray_count, input.ray_mask},
            groups_of(ray_count, 32));
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  return {executor.read(hits), executor.read(any_hits)};
}

// How many rays hit.
std::size_t expect_as_the_kernels(const RaysToTrace& input, const std::string& what) {
  const ConsumerFound found = trace_by_consumer(input);
  const TracedBoth expected = trace_in_lockstep(input, test_trace_options(1, 1));
  std::size_t hits = 0;
  for (std::size_t i = 0; i < input.rays.size(); ++i) {
    hits += has_hit(expected.hits[i]);
    for (const std::size_t k : {2 * i, 2 * i + 1}) {
      EXPECT_EQ(std::memcmp(&found.hits[k], &expected.hits[i], sizeof(Hit)), 0) << what << ", " << k;
      EXPECT_EQ(found.any_hits[k], expected.any_hits[i]) << what << ", " << k;
    }
  }
  return hits;
}

TEST_F(Traverse, FindsWhatTheKernelsFind) {
  std::size_t hits = 0;
  for (const std::string_view name : {"planar-grid", "coincident-and-random", "nested", "needles"}) {
    const HardCase* const hard_case = find_hard_case(std::string(name));
    ASSERT_TRUE(hard_case) << name;
    const std::vector<Triangle> triangles = scene_arrays(hard_case->make(500, 1)).triangles;
    const Bvh bvh = build_ploc(triangles, {});
    std::vector<Ray> rays;
    for (const RayKindName& kind : ray_kinds()) {
      const std::vector<Ray> more = hard_rays(kind.kind, triangles, bvh.nodes, 50, 1);
      rays.insert(rays.end(), more.begin(), more.end());
    }
    hits +=
        expect_as_the_kernels({.nodes = bvh.nodes, .triangles = triangles, .rays = rays}, std::string(name));
  }
  EXPECT_GT(hits, 1000u);
}

TEST_F(Traverse, KeepsToMasksAndFlags) {
  const std::vector<Triangle> triangles = random_triangles(1000, 3, 0.2f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 500, 4);
  std::vector<uint> flags;
  for (uint i = 0; i < triangles.size(); ++i)
    flags.push_back((1u << i % 8) | (i % 3 == 0 ? PRIMITIVE_NOT_OPAQUE : 0u));
  for (const uint mask : {0u, 0x11u, 0xffu}) {
    expect_as_the_kernels({.nodes = bvh.nodes,
                           .triangles = triangles,
                           .rays = rays,
                           .primitive_flags = flags,
                           .ray_mask = mask},
                          "mask " + std::to_string(mask));
  }
}

TEST_F(Traverse, FindsNothingWithoutATreeAndInOneThatDoesNotFit) {
  const std::vector<Triangle> triangles = random_triangles(200, 3, 0.5f);
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 40, 4);
  EXPECT_EQ(expect_as_the_kernels({.nodes = {}, .triangles = {}, .rays = rays}, "no tree"), 0u);
  Bvh bvh = build_ploc(triangles, {});
  bvh.nodes[0].height = 129;  // of a stack of 128
  const ConsumerFound found = trace_by_consumer({.nodes = bvh.nodes, .triangles = triangles, .rays = rays});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(found.hits[2 * i].triangle, NO_TRIANGLE);
    EXPECT_EQ(found.any_hits[2 * i], 2u);
  }
}

}  // namespace
}  // namespace coppice
