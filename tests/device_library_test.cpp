// What the library records into other programs' command buffers, on a device that is theirs: the same trees,
// orders and hits as those of the host's own builders, whatever memory they are given.
#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <thread>

#include "analysis/cpu_tracer.h"
#include "builders/hploc.h"
#include "builders/lbvh.h"
#include "builders/ploc.h"
#include "coppice/build.h"
#include "coppice/trace.h"
#include "support/library_device.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class Library : public LibraryTest {
 protected:
  // A tree, and the memory it lies in.
  struct Built {
    consumer::Buffer tree;
    TreeAddresses addresses;

    BuildState state() const { return read<BuildState>(tree, addresses.state, 1)[0]; }
    std::vector<Node> nodes() const {
      const std::uint32_t active = state().active_count;
      return read<Node>(tree, addresses.nodes, active ? 2 * active - 1 : 0);
    }
  };

  template <class Input>
  static Built build(const Builder& builder, const Input& input) {
    constexpr bool boxes = std::is_same_v<Input, BoxInput>;
    const auto tree = own().make_buffer(builder.sizes().tree_bytes);
    const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
    const VkCommandBuffer commands = own().begin();
    builder.cmd_build(commands, input, range_of(tree), range_of(scratch));
    own().run(commands);
    return {tree, boxes ? builder.box_tree(range_of(tree)) : builder.triangle_tree(range_of(tree))};
  }

  static TriangleInput plain(const consumer::Buffer& triangles, std::uint32_t count) {
    TriangleInput input;
    input.vertices = triangles.address;
    input.vertex_count = 3 * count;
    input.count.maximum = count;
    return input;
  }

  static void expect_nodes(const Built& built, const std::vector<Node>& expected, const char* what) {
    EXPECT_EQ(built.state().error_word, 0u) << what;
    const std::vector<Node> nodes = built.nodes();
    ASSERT_EQ(nodes.size(), expected.size()) << what;
    EXPECT_EQ(std::memcmp(nodes.data(), expected.data(), nodes.size() * sizeof(Node)), 0) << what;
  }
};

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

TEST_F(Library, RaysThroughNoTreeHitNothing) {
  const Built built = build(Builder(context(), 0), TriangleInput{});
  const Tracer tracer(context());
  const auto scratch = own().make_buffer(tracer.scratch_bytes()), hits = own().make_buffer(10 * sizeof(Hit));
  const auto any_hits = own().make_buffer(10 * 4);
  std::ranges::fill(any_hits.as<uint>(), 7);
  RayInput input;
  input.rays = upload(std::vector<Ray>(10, Ray{{0, 0, 0}, 0, {0, 0, 1}, 5})).address;
  input.count.maximum = 10;
  const VkCommandBuffer commands = own().begin();
  tracer.cmd_trace_closest(commands, built.addresses, input, hits.address, range_of(scratch));
  tracer.cmd_trace_any(commands, built.addresses, input, any_hits.address, range_of(scratch));
  own().run(commands);
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(hits.as<Hit>()[i].triangle, NO_TRIANGLE);
    EXPECT_EQ(hits.as<Hit>()[i].t, 5);
    EXPECT_EQ(any_hits.as<uint>()[i], 0u);
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

TEST_F(Library, BoxesHandTheirCandidatesBack) {
  constexpr std::uint32_t count = 2000, ray_count = 500, capacity = 8;
  std::vector<CoppiceBox> boxes;
  for (const Triangle& t : random_triangles(count, 5, 0.25f)) {
    const vec3 low = glm::min(t.a, t.b), high = glm::max(t.a, t.b);
    boxes.push_back({{low.x, low.y, low.z}, {high.x, high.y, high.z}});
  }
  boxes[7].box_min[1] = std::numeric_limits<float>::quiet_NaN();
  BoxInput input;
  input.boxes = upload(boxes).address;
  input.count.maximum = count;
  const Built built = build(Builder(context(), count), input);
  EXPECT_EQ(built.state().active_count, count - 1);

  std::vector<Ray> rays;  // along the z axis: which boxes they meet is a matter of comparisons
  for (const Triangle& t : random_triangles(ray_count, 6))
    rays.push_back({{t.a.x, t.a.y, -1}, 0, {0, 0, 1}, std::numeric_limits<float>::infinity()});
  const auto candidates = own().make_buffer(ray_count * capacity * sizeof(CoppiceCandidate));
  const auto counts = own().make_buffer(ray_count * 4);
  const Tracer tracer(context());
  const auto scratch = own().make_buffer(tracer.scratch_bytes());
  RayInput ray_input;
  ray_input.rays = upload(rays).address;
  ray_input.count.maximum = ray_count;
  const VkCommandBuffer commands = own().begin();
  tracer.cmd_trace_candidates(commands, built.addresses, ray_input, capacity, candidates.address,
                              counts.address, range_of(scratch));
  own().run(commands);
  std::uint32_t found = 0, more = 0;
  for (std::uint32_t i = 0; i < ray_count; ++i) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t k = 0; k < count; ++k) {
      const CoppiceBox& box = boxes[k];
      const vec3 o = rays[i].origin;
      if (o.x >= box.box_min[0] && o.x <= box.box_max[0] && o.y >= box.box_min[1] && o.y <= box.box_max[1])
        expected.push_back(k);
    }
    const std::uint32_t met = counts.as<std::uint32_t>()[i];
    ASSERT_EQ(met, expected.size()) << i;
    more += met > capacity;
    const auto kept = candidates.as<CoppiceCandidate>().subspan(i * capacity, std::min(met, capacity));
    for (std::size_t k = 0; k < kept.size(); ++k, ++found) {
      EXPECT_TRUE(std::ranges::binary_search(expected, kept[k].primitive));
      if (k > 0) {
        EXPECT_LE(kept[k - 1].t_enter, kept[k].t_enter);
      }
    }
  }
  EXPECT_GT(found, 1000u);
  EXPECT_GT(more, 0u);
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

TEST_F(Library, RaysThroughEveryTreeFindWhatTheHostFinds) {
  constexpr std::uint32_t count = 5000, ray_count = 3000;
  const std::vector<Triangle> triangles = random_triangles(count, 21, 0.1f);
  std::vector<Ray> rays;
  for (const Triangle& t : random_triangles(ray_count, 22))
    rays.push_back({t.a, 0, t.b - vec3(0.5f), std::numeric_limits<float>::infinity()});
  const Built built = build(Builder(context(), count, {.wide = true}), plain(upload(triangles), count));
  std::vector<std::uint32_t> flags;  // a third is not seen, a third not opaque
  for (std::uint32_t i = 0; i < count; ++i) flags.push_back(i % 3 == 0 ? 2u : i % 3 == 1 ? 1u : 0x1ffu);
  const auto flag_memory = upload(flags), ray_memory = upload(rays);
  const auto count_memory = upload(std::vector<std::uint32_t>{ray_count - 7});
  std::vector<Hit> expected(ray_count), expected_seen(ray_count), expected_any(ray_count);
  const auto traced = [&](auto seen, std::vector<Hit>& hits) {
    std::vector<Triangle> some = triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!seen(flags[i])) some[i].a.x = std::numeric_limits<float>::quiet_NaN();
    }
    trace_all(build_ploc(some, {}).nodes, some, rays, hits);
  };
  traced([](std::uint32_t) { return true; }, expected);
  traced([](std::uint32_t flag) { return (flag & 1) != 0; }, expected_seen);
  traced([](std::uint32_t flag) { return (flag & 1) != 0 && (flag & 0x100) == 0; }, expected_any);

  for (const TraceTree by :
       {TraceTree::automatic, TraceTree::binary, TraceTree::wide_packets, TraceTree::wide_single}) {
    const Tracer tracer(context(), by);
    const auto scratch = own().make_buffer(tracer.scratch_bytes());
    const auto hits = own().make_buffer(ray_count * 16), seen = own().make_buffer(ray_count * 16);
    const auto any = own().make_buffer(ray_count * 4), any_seen = own().make_buffer(ray_count * 4);
    RayInput input;
    input.rays = ray_memory.address;
    input.count.maximum = ray_count;
    RayInput masked = input;
    masked.ray_mask = 1;
    masked.primitive_flags = flag_memory.address;
    masked.count.address = count_memory.address;
    const VkCommandBuffer commands = own().begin();
    tracer.cmd_trace_closest(commands, built.addresses, input, hits.address, range_of(scratch));
    tracer.cmd_trace_closest(commands, built.addresses, masked, seen.address, range_of(scratch));
    tracer.cmd_trace_any(commands, built.addresses, input, any.address, range_of(scratch));
    tracer.cmd_trace_any(commands, built.addresses, masked, any_seen.address, range_of(scratch));
    own().run(commands);
    for (std::uint32_t i = 0; i < ray_count; ++i) {
      ASSERT_EQ(hits.as<Hit>()[i].triangle, expected[i].triangle) << i;
      ASSERT_EQ(any.as<uint>()[i], expected[i].triangle != NO_TRIANGLE ? 1u : 0u) << i;
      const bool counts = i < ray_count - 7;
      ASSERT_EQ(seen.as<Hit>()[i].triangle, counts ? expected_seen[i].triangle : 0u) << i;
      ASSERT_EQ(any_seen.as<uint>()[i], counts && expected_any[i].triangle != NO_TRIANGLE ? 1u : 0u) << i;
    }
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
