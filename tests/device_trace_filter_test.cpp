// Packets through the wide tree keep to masks and to counts on the device as rays by themselves do.
#include <gtest/gtest.h>

#include <random>

#include "analysis/compare.h"
#include "analysis/hard_rays.h"
#include "builders/ploc.h"
#include "support/traced.h"

namespace coppice {
namespace {

class TraceFilter : public DeviceTest {};

TEST_F(TraceFilter, PacketsWithMasksAndCounts) {
  const std::vector<Triangle> triangles = random_triangles(2000, 3, 0.2f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 500, 4);
  std::mt19937 random(1);
  std::vector<uint> flags(triangles.size()), masks(rays.size());
  for (uint& word : flags) word = random() % 512;
  for (uint& word : masks) word = random() % 256 & random() % 256;
  TraceOptions options = test_trace_options(1, 1);
  for (const bool with_flags : {true, false}) {
    for (const std::optional<uint> count : {std::optional<uint>(), std::optional(0u), std::optional(65u),
                                            std::optional(499u), std::optional(501u)}) {
      const RaysToTrace input{.nodes = bvh.nodes,
                              .triangles = triangles,
                              .rays = rays,
                              .primitive_flags = with_flags ? flags : std::vector<uint>{},
                              .ray_masks = masks,
                              .ray_mask = 0xf7,
                              .count = count};
      options.walk = Walk::binary;
      const TracedBoth binary = trace_in_lockstep(input, options);
      options.walk = Walk::wide_packets;
      const TracedBoth packets = trace_in_lockstep(input, options);
      EXPECT_EQ(packets.error_word, count.value_or(0) > rays.size() ? ERROR_RAY_COUNT : 0u);
      EXPECT_EQ(binary.error_word, packets.error_word);
      EXPECT_EQ(compare_hits(packets.hits, binary.hits).count, 0u);
      EXPECT_EQ(packets.any_hits, binary.any_hits);
      EXPECT_EQ(packets.hit_counters.hits, binary.hit_counters.hits);
      EXPECT_EQ(packets.hit_counters.rays.x, std::min(count.value_or(500), 500u));
    }
  }
}

// By every tracer, beside an error of the tree's, and where no ray may come.
TEST_F(TraceFilter, ACountBeyondTheMaximumIsNamed) {
  const std::vector<Triangle> triangles = random_triangles(200, 3, 0.2f);
  const Bvh bvh = build_ploc(triangles, {});
  const std::vector<Ray> rays = hard_rays(RayKind::RANDOM, triangles, {}, 40, 4);
  for (const std::size_t most : {std::size_t{0}, rays.size()}) {
    for (const std::size_t beyond : {std::size_t{0}, std::size_t{1}}) {
      const RaysToTrace input{.nodes = bvh.nodes,
                              .triangles = triangles,
                              .rays = std::span(rays).first(most),
                              .count = static_cast<uint>(most + beyond)};
      const uint expected = beyond > 0 ? ERROR_RAY_COUNT : 0u;
      TraceOptions options = test_trace_options(1, 1);
      for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
        options.walk = walk;
        EXPECT_EQ(trace_in_lockstep(input, options).error_word, expected) << name_of(walk) << ", " << most;
      }
      options.walk = Walk::binary;
      EXPECT_EQ(candidates_in_lockstep(input, 2, options).error_word, expected) << most;
      options.stack_entries = bvh.nodes[0].height - 1;
      EXPECT_EQ(trace_in_lockstep(input, options).error_word, expected | ERROR_TREE_TOO_DEEP) << most;
    }
  }
}

}  // namespace
}  // namespace coppice
