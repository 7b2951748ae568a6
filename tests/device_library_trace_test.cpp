// Rays that the library traces through trees in other programs' memory: what the host's tracer finds.
#include <algorithm>
#include <limits>

#include "analysis/cpu_tracer.h"
#include "builders/ploc.h"
#include "coppice/trace.h"
#include "support/library_device.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class LibraryTrace : public LibraryTreeTest {};

TEST_F(LibraryTrace, RaysThroughNoTreeHitNothing) {
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

TEST_F(LibraryTrace, BoxesHandTheirCandidatesBack) {
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

TEST_F(LibraryTrace, RaysThroughEveryTreeFindWhatTheHostFinds) {
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

}  // namespace
}  // namespace coppice
