// Refits that the library records into other programs' command buffers: the trees of the triangles as they
// lie now, hit by rays as trees that are built anew.
#include <cstring>
#include <limits>

#include "analysis/quality.h"
#include "analysis/validate.h"
#include "analysis/wide_tree.h"
#include "coppice/build.h"
#include "coppice/trace.h"
#include "interface/refit.h"
#include "support/library_device.h"
#include "support/rays.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class LibraryRefit : public LibraryTreeTest {
 protected:
  struct Updated : Built {
    consumer::Buffer update;
  };

  static Updated build_for_refits(const Builder& builder, const TriangleInput& input) {
    Updated built;
    built.tree = own().make_buffer(builder.sizes().tree_bytes);
    built.update = own().make_buffer(builder.sizes().update_bytes);
    built.addresses = builder.triangle_tree(range_of(built.tree));
    const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
    const VkCommandBuffer commands = own().begin();
    builder.cmd_build(commands, input, range_of(built.tree), range_of(scratch), range_of(built.update));
    own().run(commands);  // the scratch is gone when refits come
    return built;
  }

  static CoppiceRefitState refit(const Builder& builder, const Updated& built, const TriangleInput& input) {
    const VkCommandBuffer commands = own().begin();
    builder.cmd_refit(commands, input, range_of(built.tree), range_of(built.update));
    builder.cmd_tree_cost(commands, input.count.maximum, range_of(built.tree), range_of(built.update));
    own().run(commands);
    return read<CoppiceRefitState>(built.tree, built.addresses.refit_state, 1)[0];
  }

  static std::vector<WideNode> wide_nodes(const Updated& built) {
    const auto counts = read<WideCounts>(built.tree, built.addresses.wide_counts, 1)[0];
    return read<WideNode>(built.tree, built.addresses.wide_nodes, counts.node_count);
  }

  static std::vector<Hit> hits(const Tracer& tracer, const TreeAddresses& tree,
                               const std::vector<Ray>& rays) {
    const auto ray_memory = upload(rays);
    const auto hit_memory = own().make_buffer(rays.size() * sizeof(Hit));
    const auto scratch = own().make_buffer(tracer.scratch_bytes());
    RayInput input;
    input.rays = ray_memory.address;
    input.count.maximum = static_cast<std::uint32_t>(rays.size());
    const VkCommandBuffer commands = own().begin();
    tracer.cmd_trace_closest(commands, tree, input, hit_memory.address, range_of(scratch));
    own().run(commands);
    return read<Hit>(hit_memory, hit_memory.address, rays.size());
  }
};

TEST_F(LibraryRefit, NothingHasTheBoxThatTheHeadersSay) { EXPECT_EQ(COPPICE_NOTHING_BOX, NOTHING_BOX); }

TEST_F(LibraryRefit, ATreeThatIsNotRefittedNeedsNoUpdateMemory) {
  constexpr std::uint32_t count = 3000;
  const Builder builder(context(), 5000, {.wide = true, .refits = true});
  const Builder plain_builder(context(), count, {.wide = true});
  const Tracer tracer(context());
  const std::vector<Triangle> triangles = random_triangles(count, 1, 0.1f);
  const auto memory = upload(triangles);
  const std::vector<Ray> rays = rays_around(std::span(triangles).last(1), 300, 1);
  const Built once = build(builder, plain(memory, count)), other = build(plain_builder, plain(memory, count));
  const std::vector<Hit> found = hits(tracer, once.addresses, rays);
  const std::vector<Hit> expected = hits(tracer, other.addresses, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(found[i].triangle, expected[i].triangle) << i;
}

// Triangles that go, come, and were not there when the tree was built.
TEST_F(LibraryRefit, FramesOfATree) {
  constexpr std::uint32_t count = 3000;
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<Triangle> triangles = random_triangles(count, 1, 0.1f);
  triangles[5].a.x = infinity;
  for (const DeviceBuilder by : {DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh}) {
    const Builder builder(context(), 20000, {.builder = by, .wide = true, .refits = true});
    const Builder plain_builder(context(), count, {.builder = by, .wide = true});
    const Tracer tracer(context());
    const Updated built = build_for_refits(builder, plain(upload(triangles), count));
    const std::vector<Node> nodes = built.nodes();
    const CoppiceRefitState same = refit(builder, built, plain(upload(triangles), count));
    expect_nodes(built, nodes, "where nothing moved");
    EXPECT_EQ(same.appeared_count, 0u);
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
      std::vector<Triangle> moved = random_triangles(count, 1 + frame, 0.1f);
      for (std::uint32_t i = frame; i < count; i += 11) moved[i].c.y = infinity;
      if (frame < 3) moved[5].b.z = infinity;
      const auto memory = upload(moved);
      const CoppiceRefitState state = refit(builder, built, plain(memory, count));
      EXPECT_EQ(state.appeared_count, frame == 3 ? 1u : 0u);
      EXPECT_EQ(built.state().error_word, 0u);
      const double cost = measure_quality(built.nodes()).sah;
      EXPECT_NEAR(state.area_sum / state.root_area, cost, 1e-4 * cost);
      if (frame == 3) continue;
      EXPECT_EQ(find_fault(built.nodes(), moved, {.refitted = true}), std::nullopt);
      EXPECT_EQ(find_wide_fault(wide_nodes(built), built.nodes(), true), std::nullopt);
      const std::vector<Ray> rays = rays_around(std::span(moved).last(1), 500, frame);
      const std::vector<Hit> found = hits(tracer, built.addresses, rays);
      const Built anew = build(plain_builder, plain(memory, count));
      const std::vector<Hit> expected = hits(tracer, anew.addresses, rays);
      for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(found[i].triangle, expected[i].triangle) << i;
    }
  }
}

TEST_F(LibraryRefit, OfNoneOneAndTwoTriangles) {
  for (const std::uint32_t most : {0u, 1u, 2u}) {
    const Builder builder(context(), most, {.refits = true});
    EXPECT_GT(builder.sizes().update_bytes, 0u);
    for (std::uint32_t count = 0; count <= most; ++count) {
      const Updated built = build_for_refits(builder, plain(upload(random_triangles(count + 1, 1)), count));
      const std::vector<Triangle> moved = random_triangles(count + 1, 9);
      refit(builder, built, plain(upload(moved), count));
      EXPECT_EQ(find_fault(built.nodes(), std::span(moved).first(count), {.refitted = true}), std::nullopt);
    }
  }
}

TEST_F(LibraryRefit, WhatCannotBeIsNamedAndRecordsNothing) {
  constexpr std::uint32_t count = 100;
  const Builder builder(context(), count, {.refits = true}), without(context(), count);
  EXPECT_EQ(without.sizes().update_bytes, 0u);
  EXPECT_GE(build_sizes(context(), count, {.refits = true}).update_bytes, builder.sizes().update_bytes);
  const TriangleInput input = plain(upload(random_triangles(count, 1)), count);
  const auto memory = own().make_buffer(1 << 20), other = own().make_buffer(1 << 20);
  const VkCommandBuffer commands = own().begin();
  const auto refused = [&](const auto& call, const char* what) {
    try {
      call();
      ADD_FAILURE() << what << ": not refused";
    } catch (const ArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  const MemoryRange tree = range_of(memory), update = range_of(other), none;
  refused([&] { without.cmd_refit(commands, input, tree, update); }, "refits");
  refused([&] { without.cmd_build(commands, input, tree, update, update); }, "refits");
  refused([&] { without.cmd_tree_cost(commands, count, tree, update); }, "refits");
  refused([&] { builder.cmd_refit(commands, input, tree, none); }, "update");
  refused([&] { builder.cmd_refit(commands, input, tree, tree); }, "update");
  refused([&] { builder.cmd_refit(commands, input, none, update); }, "tree");
  refused([&] { builder.cmd_tree_cost(commands, count + 1, tree, update); }, "count");
  TriangleInput more = input;
  more.count.maximum = count + 1;
  refused([&] { builder.cmd_refit(commands, more, tree, update); }, "count");
  own().run(commands);
}

}  // namespace
}  // namespace coppice
