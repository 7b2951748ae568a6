// A trace that is cut into pieces gives the bits and the counters of the whole, wherever it is cut. By the
// twins, so that it needs no device.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <optional>
#include <random>

#include "builders/ploc.h"
#include "pipeline/trace_pieces.h"
#include "pipeline/wide_plan.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/cpu_executor.h"

namespace coppice {
namespace {

struct Traced {
  std::vector<uint> image;
  std::vector<uint> counters;
  std::vector<vec3> radiance;
  std::uint64_t work = 0;
  int pieces = 0;

  bool same_bits(const Traced& other) const {
    return image == other.image && counters == other.counters && radiance == other.radiance;
  }
};

// A scene with its tree, traced by pieces of the work that `next_work` says.
class CutTrace {
 public:
  CutTrace(std::uint32_t triangle_count, const TraceOptions& options)
      : arrays_(scene_arrays(find_hard_case("sphere")->make(triangle_count, 1))), options_(options) {}

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(arrays_.triangles.size()); }

  Traced run(const std::function<std::uint64_t()>& next_work) const {
    const Bvh bvh = build_ploc(arrays_.triangles, {});
    Layout layout;
    TreeSlots tree = plan_tree(layout, triangle_count(), bvh.nodes.size());
    std::optional<WidePlan> wide;
    if (is_wide(options_.walk)) wide = plan_wide(layout, tree);
    const TracePlan plan =
        plan_trace(layout, tree, static_cast<std::uint32_t>(arrays_.materials.size()), options_);
    CpuExecutor executor(layout);
    const Scene scene = find_hard_case("sphere")->make(triangle_count(), 1);
    upload_frame(executor, tree, plan, arrays_,
                 make_film(scene, {}, options_.width, options_.height, options_.samples));
    BuildState state{};
    state.active_count = bvh.active_count;
    executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
    executor.upload(tree.state, std::span<const BuildState>(&state, 1));
    Chain conversion = executor.chain();
    if (wide) append_wide(conversion, tree, *wide);
    executor.run(conversion.steps());

    Traced traced;
    TracePieces pieces(tree, plan);
    while (!pieces.done()) {
      const std::uint64_t most = next_work();
      Chain chain = executor.chain();
      const std::uint64_t work = pieces.append(chain, most);
      EXPECT_GT(work, 0u);
      EXPECT_LE(work, std::max(most, least_work())) << "of " << most;
      executor.run(chain.steps());
      traced.work += work;
      ++traced.pieces;
    }
    EXPECT_EQ(traced.work, pieces.work());
    traced.image = executor.read(plan.image);
    if (options_.keep_radiance) traced.radiance = executor.read(plan.radiance);
    const TraceCounters counters = executor.read(plan.counters)[0];
    traced.counters.resize(sizeof counters / sizeof(uint));
    std::memcpy(traced.counters.data(), &counters, sizeof counters);
    return traced;
  }

  Traced whole() const {
    return run([] { return ~std::uint64_t{0}; });
  }

 private:
  // Of one step of the least range; a range that is open keeps its rays.
  std::uint64_t least_work() const {
    return options_.walk == Walk::brute_force ? most_open_rays * std::min(BRUTE_FORCE_SLICE, triangle_count())
                                              : RANGE_RAYS;
  }

  static constexpr std::uint64_t most_open_rays = 8192;
  SceneArrays arrays_;
  TraceOptions options_;
};

TraceOptions options_of(std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
  TraceOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  return options;
}

void expect_same_however_cut(const CutTrace& trace, std::uint64_t most_work) {
  const Traced whole = trace.whole();
  EXPECT_EQ(whole.pieces, 1);
  EXPECT_TRUE(std::ranges::any_of(whole.image, [&](uint pixel) { return pixel != whole.image[0]; }));
  const Traced least = trace.run([] { return std::uint64_t{1}; });
  EXPECT_GT(least.pieces, 1);
  EXPECT_TRUE(least.same_bits(whole)) << "in the least pieces";
  std::mt19937 random(1);
  for (int i = 0; i < 3; ++i) {
    const Traced cut = trace.run([&] { return 1 + random() % most_work; });
    EXPECT_TRUE(cut.same_bits(whole)) << i;
  }
}

TEST(TracePieces, OfTheBinaryTree) { expect_same_however_cut({3000, options_of(83, 61, 3)}, 5000); }

TEST(TracePieces, OfTheWideTreeInPackets) {
  TraceOptions options = options_of(83, 61, 3);
  options.walk = Walk::wide_packets;
  expect_same_however_cut({3000, options}, 5000);
}

TEST(TracePieces, OfTheWideTreeRayByRay) {
  TraceOptions options = options_of(83, 61, 3);
  options.walk = Walk::wide_single;
  expect_same_however_cut({3000, options}, 5000);
}

TEST(TracePieces, OfBruteForceWithinTheSlicesOfItsTriangles) {
  TraceOptions options = options_of(17, 16, 2);
  options.walk = Walk::brute_force;
  const CutTrace trace(BRUTE_FORCE_SLICE + 1000, options);
  ASSERT_GT(trace.triangle_count(), BRUTE_FORCE_SLICE);
  expect_same_however_cut(trace, std::uint64_t{200} * trace.triangle_count());
}

TEST(TracePieces, OfAPictureOfMoreThanOneBand) {
  const CutTrace trace(300, options_of(1027, 1030, 1));
  const Traced whole = trace.whole();
  std::mt19937 random(2);
  EXPECT_TRUE(trace.run([&] { return 1 + random() % 600000; }).same_bits(whole));
}

// Over two bands, the second a part of one.
TEST(TracePieces, RadianceOfTheWholePictureIsThatOfItsPixels) {
  TraceOptions options = options_of(1027, 1030, 2);
  const Traced plain = CutTrace(300, options).whole();
  options.keep_radiance = true;
  const Traced kept = CutTrace(300, options).whole();
  EXPECT_EQ(kept.image, plain.image);
  EXPECT_EQ(kept.counters, plain.counters);
  const std::vector<vec3> means = mean_radiance(kept.radiance, 1027, 1030, 2);
  ASSERT_EQ(means.size(), kept.image.size());
  const auto thresholds = srgb_thresholds();
  std::size_t differing = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const uint code = kept.image[i] >> (8 * channel) & 255;
      const float x = means[i][channel];
      const bool fits = x >= std::bit_cast<float>(thresholds[code]) &&
                        (code == 255 || x < std::bit_cast<float>(thresholds[code + 1]));
      differing += !fits;
    }
  }
  EXPECT_EQ(differing, 0u);
}

TEST(TracePieces, WithoutAskingForItNoRadianceIsKept) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  TraceOptions options = options_of(640, 480, 1);
  EXPECT_EQ(plan_trace(layout, tree, 1, options).radiance.count, 0u);
  options.samples = 2;
  options.width = options.height = 2048;
  EXPECT_EQ(plan_trace(layout, tree, 1, options).radiance.count, 1u << 20);
  options.keep_radiance = true;
  EXPECT_EQ(plan_trace(layout, tree, 1, options).radiance.count, 1u << 22);
}

// Pieces do not grow with the samples: neither do the memory nor the time of one.
TEST(TracePieces, StepsOfAPieceFollowFromItsWorkAlone) {
  TraceOptions options = options_of(1024, 768, 65536);
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan = plan_trace(layout, tree, 1, options);
  TracePieces pieces(tree, plan);
  for (int i = 0; i < 100; ++i) {
    const std::vector<std::uint64_t> addresses(layout.block_bytes().size(), 0);
    Chain chain(addresses);
    pieces.append(chain, 1 << 20);
    EXPECT_LE(chain.steps().size(), 10u);
  }
  EXPECT_FALSE(pieces.done());
}

TEST(HitPieces, NoRaysAreNoPieces) {
  const TreeSlots tree{};
  EXPECT_TRUE(HitPieces(tree, RaySlots{}, 0, {}).done());
  EXPECT_TRUE(AnyHitPieces(tree, AnyHitSlots{}, 0, {}).done());
}

// With a mask a ray, so that pieces which took those of others would show.
TEST(AnyHitPieces, GiveTheWordsOfTheWhole) {
  const std::vector<Triangle> triangles = scene_arrays(find_hard_case("sphere")->make(500, 1)).triangles;
  const Bvh bvh = build_ploc(triangles, {});
  constexpr std::uint32_t ray_count = 5 * RANGE_RAYS + 7;
  std::mt19937 random(1);
  const auto next = [&] { return static_cast<float>(random() % 2001) / 1000 - 1; };
  std::vector<Ray> rays;
  std::vector<uint> masks;
  for (std::uint32_t i = 0; i < ray_count; ++i) {
    const float x = next(), y = next(), z = next();
    rays.push_back({{}, 0, {x, y, z}, 1e30f});
    masks.push_back(random() % 2);
  }
  const auto any_hits = [&](std::uint64_t work) {
    Layout layout;
    const TreeSlots tree = plan_tree(layout, static_cast<std::uint32_t>(triangles.size()), bvh.nodes.size());
    AnyHitSlots slots = plan_any_hits(layout, ray_count);
    slots.filter.ray_masks = layout.add<uint>("ray_masks", ray_count);
    CpuExecutor executor(layout);
    BuildState state{};
    state.active_count = bvh.active_count;
    executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
    executor.upload(tree.triangles, std::span<const Triangle>(triangles));
    executor.upload(tree.state, std::span<const BuildState>(&state, 1));
    executor.upload(slots.rays, std::span<const Ray>(rays));
    executor.upload(slots.filter.ray_masks, std::span<const uint>(masks));
    std::size_t pieces = 0;
    for (AnyHitPieces left(tree, slots, ray_count, {}); !left.done(); ++pieces) {
      Chain chain = executor.chain();
      left.append(chain, work);
      executor.run(chain.steps());
    }
    EXPECT_EQ(pieces, work == 1 ? 6u : 1u);
    EXPECT_EQ(executor.read(slots.counters)[0].rays.x, ray_count);
    return executor.read(slots.any_hits);
  };
  const std::vector<uint> whole = any_hits(1 << 20);
  EXPECT_EQ(any_hits(1), whole);
  EXPECT_GT(std::ranges::count(whole, 1u), 100);
  EXPECT_GT(std::ranges::count(whole, 0u), 100);
}

}  // namespace
}  // namespace coppice
