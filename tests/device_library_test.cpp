// What the library records into other programs' command buffers, on a device that is theirs: the same trees,
// orders and hits as those of the host's own builders, whatever memory they are given.
#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <thread>

#include "builders/hploc.h"
#include "builders/lbvh.h"
#include "builders/ploc.h"
#include "coppice/build.h"
#include "support/library_device.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class Library : public LibraryTreeTest {};

TEST_F(Library, BuildersGiveTheTreesOfTheHost) {
  for (const std::uint32_t count : {1u, 2u, 897u, 20000u}) {
    const std::vector<Triangle> triangles = random_triangles(count, count);
    const auto memory = upload(triangles);
    for (const std::uint32_t bits : {30u, 60u}) {
      const auto built_by = [&](DeviceBuilder builder) {
        return build(Builder(context(), 20000, {.builder = builder, .morton_bits = bits}),
                     plain(memory, count));
      };
      expect_nodes(built_by(DeviceBuilder::ploc), build_ploc(triangles, {.morton_bits = bits}).nodes, "ploc");
      expect_nodes(built_by(DeviceBuilder::hploc),
                   build_hploc(triangles, {.radius = 16, .morton_bits = bits}).nodes, "hploc");
      expect_nodes(built_by(DeviceBuilder::lbvh), build_lbvh(triangles, {.morton_bits = bits}).nodes, "lbvh");
    }
  }
}

// The slots are those of the maximum, whose sort has other digits than that of few.
TEST_F(Library, ABuilderOfManyBuildsFew) {
  const Builder builder(context(), 300000, {.wide = true});
  for (const std::uint32_t count : {0u, 1u, 5000u, 40000u}) {
    const std::vector<Triangle> triangles = random_triangles(count, 3);
    expect_nodes(build(builder, plain(upload(triangles), count)), build_ploc(triangles, {}).nodes, "ploc");
  }
}

TEST_F(Library, SizesAreKnownBeforeABuilderIs) {
  for (const std::uint32_t most : {0u, 1u, 20000u}) {
    const BuildSizes before = build_sizes(context(), most, {.wide = true});
    const BuildSizes sizes = Builder(context(), most, {.wide = true}).sizes();
    EXPECT_GE(before.tree_bytes, sizes.tree_bytes);
    EXPECT_GE(before.scratch_bytes, sizes.scratch_bytes);
    EXPECT_GT(sizes.tree_bytes, 0u);
  }
}

TEST_F(Library, IndicesStridesAndTransformsAreTheTrianglesTheyStandFor) {
  constexpr std::uint32_t count = 3000, vertex_count = 2000;
  const std::vector<Triangle> corners = random_triangles(vertex_count, 1);
  struct Vertex {
    float padding[2];
    vec3 position;
  };
  std::vector<Vertex> vertices;
  for (const Triangle& t : corners) vertices.push_back({{7, 7}, t.a});
  std::vector<std::uint32_t> wide;
  for (std::uint32_t i = 0; i < 3 * count; ++i) wide.push_back((i * 7919u + i / 5) % (vertex_count - 10));
  const std::vector<std::uint16_t> narrow(wide.begin(), wide.end());
  // Exact, so that the host may compute it in any order: axes change places, powers of two, small integers.
  const std::vector<float> transform = {0, 2, 0, 1, 0.5f, 0, 0, -2, 0, 0, 4, 3};
  std::vector<Triangle> expected;
  const auto corner = [&](std::uint32_t i) {
    const vec3 p = vertices[wide[i] + 10].position;
    return vec3(2 * p.y + 1, 0.5f * p.x - 2, 4 * p.z + 3);
  };
  for (std::uint32_t i = 0; i < count; ++i)
    expected.push_back({corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)});

  TriangleInput input;
  const auto vertex_memory = upload(vertices), transform_memory = upload(transform);
  input.vertices = vertex_memory.address + offsetof(Vertex, position);
  input.vertex_stride = sizeof(Vertex);
  input.vertex_count = vertex_count;
  input.first_vertex = 10;
  input.transform = transform_memory.address;
  input.count.maximum = count;
  const Builder builder(context(), count);
  const std::vector<Node> nodes = build_ploc(expected, {}).nodes;
  input.indices = upload(wide).address;
  expect_nodes(build(builder, input), nodes, "32 bits");
  input.indices = upload(narrow).address;
  input.index_type = VK_INDEX_TYPE_UINT16;
  const Built built = build(builder, input);
  expect_nodes(built, nodes, "16 bits");
  const auto kept = read<Triangle>(built.tree, built.addresses.triangles, count);
  EXPECT_EQ(std::memcmp(kept.data(), expected.data(), count * sizeof(Triangle)), 0);
}

TEST_F(Library, CountsOnTheDevice) {
  constexpr std::uint32_t maximum = 20000;
  const std::vector<Triangle> triangles = random_triangles(maximum, 9);
  const auto memory = upload(triangles);
  for (const DeviceBuilder by : {DeviceBuilder::ploc, DeviceBuilder::hploc}) {
    const Builder builder(context(), maximum, {.builder = by});
    for (const std::uint32_t count : {0u, 1u, 12345u, maximum, maximum + 1}) {
      TriangleInput input = plain(memory, maximum);
      input.count.address = upload(std::vector<std::uint32_t>{count}).address;
      const Built built = build(builder, input);
      EXPECT_EQ(built.state().primitive_count, count);
      if (count > maximum) {
        EXPECT_EQ(built.state().error_word, COPPICE_ERROR_COUNT);
        EXPECT_EQ(built.state().active_count, 0u);
        continue;
      }
      const auto first = std::span(triangles).first(count);
      expect_nodes(
          built,
          by == DeviceBuilder::ploc ? build_ploc(first, {}).nodes : build_hploc(first, {.radius = 16}).nodes,
          "counted");
    }
  }
}

TEST_F(Library, ABatchIsAsManyTreesOfTheirOwn) {
  constexpr std::uint32_t count = 2000;
  const std::vector<Triangle> triangles = random_triangles(count, 11);
  const std::vector<CoppiceRange> ranges = {{0, 1}, {1, 63}, {64, 0}, {64, 512}, {600, 300}, {900, 513}};
  const auto memory = upload(triangles), range_memory = upload(ranges);
  const BatchBuilder builder(context(), count, 10);
  const auto tree = own().make_buffer(builder.sizes().tree_bytes);
  const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
  const VkCommandBuffer commands = own().begin();
  builder.cmd_build(commands, plain(memory, count), range_memory.address,
                    {static_cast<std::uint32_t>(ranges.size())}, range_of(tree), range_of(scratch));
  own().run(commands);
  const BatchAddresses at = builder.triangle_trees(range_of(tree));
  const auto trees = read<CoppiceBatchTree>(tree, at.trees, ranges.size());
  EXPECT_EQ(read<BuildState>(tree, at.state, 1)[0].error_word, COPPICE_ERROR_BATCH_RANGE);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i].count > COPPICE_BATCH_MAX_PRIMITIVES) {
      EXPECT_EQ(trees[i].error_word, COPPICE_ERROR_BATCH_RANGE);
      continue;
    }
    ASSERT_EQ(trees[i].active_count, ranges[i].count);
    const auto expected =
        build_ploc(std::span(triangles).subspan(ranges[i].first, ranges[i].count), {}).nodes;
    const auto nodes = read<Node>(tree, at.nodes + ranges[i].first * 2 * sizeof(Node), expected.size());
    EXPECT_EQ(std::memcmp(nodes.data(), expected.data(), nodes.size() * sizeof(Node)), 0) << i;
  }
}

TEST_F(Library, SeveralThreadsAndContextsRecordAtOnce) {
  constexpr std::uint32_t count = 3000, threads = 4, builds = 5;
  const std::vector<Triangle> triangles = random_triangles(count, 31);
  const std::vector<Node> expected = build_ploc(triangles, {}).nodes;
  const auto memory = upload(triangles);
  const Context other(adopted());
  const Builder builder(context(), count), another(other, count);
  const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
  std::vector<consumer::Buffer> trees;
  std::vector<VkCommandBuffer> commands;
  for (std::uint32_t i = 0; i < threads; ++i) {
    commands.push_back(own().begin(own().make_pool()));
    for (std::uint32_t k = 0; k < builds; ++k) trees.push_back(own().make_buffer(builder.sizes().tree_bytes));
  }
  std::vector<std::thread> recording;
  for (std::uint32_t i = 0; i < threads; ++i) {
    recording.emplace_back([&, i] {
      for (std::uint32_t k = 0; k < builds; ++k)
        (i % 2 ? builder : another)
            .cmd_build(commands[i], plain(memory, count), range_of(trees[i * builds + k]), range_of(scratch));
    });
  }
  for (std::thread& thread : recording) thread.join();
  for (const VkCommandBuffer one : commands) own().run(one);
  for (const consumer::Buffer& tree : trees)
    expect_nodes({tree, builder.triangle_tree(range_of(tree))}, expected, "of a thread");
}

TEST_F(Library, QueriesTellTheTimeOfEveryKernel) {
  constexpr std::uint32_t count = 2000, capacity = 400;
  if (context().capabilities().timestamp_period_ns == 0) GTEST_SKIP() << "no timestamps";
  const auto memory = upload(random_triangles(count, 41));
  const Builder builder(context(), count);
  const auto tree = own().make_buffer(builder.sizes().tree_bytes);
  const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
  auto info = consumer::structure<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = capacity;
  VkQueryPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateQueryPool(own().device, &info, nullptr, &pool), VK_SUCCESS);
  for (const std::uint32_t asked : {capacity, 3u, 0u}) {
    std::vector<const char*> names(capacity);
    KernelQueries queries{pool, 0, asked, names.data(), 77};
    const VkCommandBuffer commands = own().begin();
    vkCmdResetQueryPool(commands, pool, 0, capacity);
    builder.cmd_build(commands, plain(memory, count), range_of(tree), range_of(scratch), &queries);
    own().run(commands);
    ASSERT_LE(queries.written, asked);
    if (asked < capacity) {
      EXPECT_EQ(queries.written, asked);
      continue;
    }
    ASSERT_GT(queries.written, 10u);
    std::vector<std::uint64_t> ticks(queries.written);
    ASSERT_EQ(vkGetQueryPoolResults(own().device, pool, 0, queries.written, ticks.size() * 8, ticks.data(), 8,
                                    VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_TRUE(std::ranges::is_sorted(ticks));
    EXPECT_STREQ(names[0], "begin");
    EXPECT_STREQ(names[queries.written - 1], "ploc_finish");
    EXPECT_EQ(std::ranges::count(std::span(names).first(queries.written), std::string_view("morton_codes"),
                                 [](const char* name) { return std::string_view(name); }),
              1);
  }
  vkDestroyQueryPool(own().device, pool, nullptr);
}

}  // namespace
}  // namespace coppice
