// Every stage gives the same bits on the device as its twin does, and a fault in any stage is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/lockstep.h"
#include "support/planted_faults.h"

namespace coppice {
namespace {

class Lockstep : public DeviceTest {};

void expect_equal(std::span<const Triangle> triangles, const BuildOptions& options, const std::string& what) {
  expect_build_in_lockstep(triangles, options, what);
}

TEST_F(Lockstep, SizesUpTo300) {
  for (std::uint32_t size = 0; size <= 300; ++size) {
    expect_equal(random_triangles(size, size), {}, std::to_string(size) + " triangles");
  }
}

TEST_F(Lockstep, PowersOfTwoAndTheirNeighbours) {
  for (std::uint32_t exponent = 9; exponent <= 16; ++exponent) {
    for (const std::uint32_t size : {(1u << exponent) - 1, 1u << exponent, (1u << exponent) + 1}) {
      BuildOptions options;
      options.radius = 4;
      expect_equal(random_triangles(size, size), options, std::to_string(size) + " triangles");
    }
  }
}

TEST_F(Lockstep, AMillionTriangles) {
  BuildOptions options;
  options.radius = 2;
  expect_equal(random_triangles(1000000, 1), options, "a million triangles");
}

struct Variant {
  const char* name;
  BuildOptions options;
};

class LockstepVariants : public DeviceTest, public testing::WithParamInterface<Variant> {};

TEST_P(LockstepVariants, SameBits) {
  expect_equal(random_triangles(30000, 7), GetParam().options, GetParam().name);
}

BuildOptions variant(std::uint32_t radius, std::uint32_t bits, bool lookback = true,
                     std::uint32_t turns = 16) {
  BuildOptions options;
  options.radius = radius;
  options.morton_bits = bits;
  options.lookback = lookback;
  options.lookback_turns = turns;
  return options;
}

BuildOptions sorted_by(std::uint32_t sort, std::uint32_t bits) {
  BuildOptions options = variant(8, bits);
  options.variants.sort = sort;
  return options;
}

INSTANTIATE_TEST_SUITE_P(Options, LockstepVariants,
                         testing::Values(Variant{"radius1", variant(1, 30)},
                                         Variant{"radius2", variant(2, 60)},
                                         Variant{"radius8", variant(8, 30)},
                                         Variant{"radius16", variant(16, 60)},
                                         Variant{"radius100", variant(100, 30)},
                                         Variant{"without_lookback", variant(8, 30, false)},
                                         Variant{"without_lookback_60_bits", variant(8, 60, false)},
                                         Variant{"no_polls_so_fallbacks", variant(8, 30, true, 0)},
                                         Variant{"sort_scan", sorted_by(SORT_SCAN, 30)},
                                         Variant{"sort_scan_60_bits", sorted_by(SORT_SCAN, 60)},
                                         Variant{"sort_scan_8", sorted_by(SORT_SCAN_8, 30)},
                                         Variant{"sort_match", sorted_by(SORT_ONESWEEP_MATCH, 30)}),
                         [](const auto& info) { return info.param.name; });

class LockstepHardCases : public DeviceTest, public testing::WithParamInterface<std::string_view> {};

TEST_P(LockstepHardCases, SameBits) {
  const HardCase* const hard_case = find_hard_case(GetParam());
  const std::uint32_t count = std::min(hard_case->default_triangle_count, 20000u);
  expect_equal(scene_arrays(hard_case->make(count, 1)).triangles, {}, std::string(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Cases, LockstepHardCases, testing::ValuesIn(hard_case_names()),
                         [](const auto& info) {
                           std::string name(info.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

// The search goes in blocks as wide as a subgroup. Radii about the width of a block, and equal distances
// within a block and across.
TEST_F(Lockstep, TiesAtRadiiThatEndWithinBlocks) {
  for (const char* name : {"planar-grid", "coincident-and-random"}) {
    const auto triangles = scene_arrays(find_hard_case(name)->make(3000, 1)).triangles;
    for (const std::uint32_t radius : {3u, 7u, 9u, 17u, 33u})
      expect_equal(triangles, variant(radius, 30), name + std::string(" ") + std::to_string(radius));
  }
}

TEST_F(Lockstep, WholeFrame) {
  const Scene scene = find_hard_case("nested")->make(3000, 1);
  const SceneArrays arrays = scene_arrays(scene);
  for (const Walk walk : {Walk::binary, Walk::brute_force}) {
    Layout layout(test_device().properties().max_block_bytes);
    const BuildPlan build = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()), {});
    TraceOptions options = test_trace_options(61, 47);
    options.samples = 3;
    options.walk = walk;
    const TracePlan trace =
        plan_trace(layout, build, static_cast<std::uint32_t>(arrays.materials.size()), options);
    LockstepExecutor executor(test_device(), layout);
    upload_frame(executor, build, trace, arrays, make_film(scene, {}, 61, 47, 3));
    const auto difference = executor.run([&](Chain& chain) {
      append_build(chain, build);
      append_trace(chain, build, trace);
    });
    EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                             << "]";
    EXPECT_GT(executor.cpu().read(trace.counters)[0].hits.x, 0u);
  }
}

// The pixels of so much radiance, in lockstep.
std::vector<uint> resolved(const std::vector<vec3>& radiance, const ToneMapping& tone = {}) {
  const auto count = static_cast<std::uint32_t>(radiance.size());
  Layout layout(test_device().properties().max_block_bytes);
  TraceOptions options = test_trace_options(count, 1);
  options.samples = 2;  // radiance is kept
  const TracePlan trace = plan_trace(layout, plan_tree(layout, 1, 1), 1, options);
  LockstepExecutor executor(test_device(), layout);
  const Film film{{}, count, {}, 1, {}, 1, {}, 0, {}, 0, {}, 0};
  const auto thresholds = srgb_thresholds();
  executor.upload(trace.film, std::span<const Film>(&film, 1));
  executor.upload(trace.srgb_thresholds, std::span<const uint>(thresholds));
  executor.upload(trace.radiance, std::span<const vec3>(radiance));
  const auto difference = executor.run([&](Chain& chain) {
    chain.run(stages::resolve,
              {chain.at(trace.film),
               chain.at(trace.radiance),
               {},
               chain.at(trace.srgb_thresholds),
               chain.at(trace.image),
               0,
               count,
               std::bit_cast<uint>(tone.exposure()),
               tone.curve},
              groups_of(count, RESOLVE_GROUP), {0, tone.curve, tone.exposure() != 1});
  });
  EXPECT_FALSE(difference) << "pixel " << difference->index << "\ncpu " << difference->cpu << "\ngpu "
                           << difference->gpu;
  return executor.gpu().read(trace.image);
}

// A scene may overflow, and its file may hold anything; the twin and every device show the same for it.
TEST_F(Lockstep, ColoursOutsideOfAPicture) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<uint> pixels = resolved(
      {{nan, 0.05f, 1}, {0.5f, -nan, nan}, {infinity, -infinity, 2}, {-1, -0.0f, 0.0f}, {1e-30f, 1, 3e38f}});
  const std::vector<uint> expected = {0xffff3f00, 0xff0000bc, 0xffff00ff, 0xff000000, 0xffffff00};
  EXPECT_EQ(pixels, expected);
}

// Where one sRGB code ends and the next one begins, and densely between.
TEST_F(Lockstep, EveryCodeOfAColour) {
  std::vector<vec3> radiance;
  for (const uint bits : srgb_thresholds()) {
    const float least = std::bit_cast<float>(bits);
    if (least > 0) radiance.push_back({std::nextafter(least, 0.0f), least, std::nextafter(least, 2.0f)});
  }
  for (int i = 0; i < 20000; ++i) radiance.push_back(vec3(static_cast<float>(i) / 20000.0f));
  const std::vector<uint> pixels = resolved(radiance);
  for (uint code = 1; code < 256; ++code) EXPECT_EQ(pixels[code - 1] & 0xffffff, code * 0x10101 - 1) << code;
}

// Every tone curve, exposed or not, from dark to bright, of colours and of what is none.
TEST_F(Lockstep, EveryToneCurve) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<vec3> radiance = {{nan, -1, 1}, {infinity, 1, 0}, {-infinity, 3e38f, 1e-38f}, {0, 0, 0}};
  for (int i = 0; i < 4000; ++i) {
    const float x = std::ldexp(1 + static_cast<float>(i % 100) / 100, i / 100 - 20);
    radiance.push_back(vec3(x));
    radiance.push_back({x, 0.3f, 1 / x});
  }
  std::vector<std::vector<uint>> pictures;
  for (const uint curve : {TONE_NONE, TONE_REINHARD, TONE_ACES}) {
    for (const double stops : {0.0, 2.5}) pictures.push_back(resolved(radiance, {curve, stops}));
  }
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(pictures[i], pictures[k]) << i << ", " << k;
  }
}

// --- Planted faults.

struct StageFault {
  const char* stage;
  const char* slot;
  StageDeclaration declaration;
  DeviceBuilder builder = DeviceBuilder::ploc;
  bool lookback = true;
  std::uint32_t triangles = 3000;
};

constexpr std::uint32_t two_sort_tiles = SORT_SCAN_TILE + 100;  // one alone counts and scans in sort_scatter

void wrong_shift(const void* args) {
  auto sort = args_of<SortPassArgs>(args);
  sort.pass = (sort.pass + 1) % 4;
  for (uint digit = 0; digit < SORT_DIGITS; ++digit) sort.keys_out[digit % sort.count] >>= sort.pass;
}

std::vector<StageFault> stage_faults() {
  return {
      {"primitive_bounds", "boxes",
       faulty<&stages::primitive_bounds,
              [](const void* args) {
                const auto a = args_of<PrimitiveBoundsArgs>(args);
                a.boxes[a.triangle_count].box_min.x = 1;  // one past the end
              }>()},
      {"morton_codes", "keys_a",
       faulty<&stages::morton_codes,
              [](const void* args) { args_of<MortonCodesArgs>(args).keys[5] <<= 1; }>()},
      {"sort_histogram", "histogram",
       faulty<&stages::sort_histogram,
              [](const void* args) { ++args_of<SortHistogramArgs>(args).histogram[0]; }>()},
      {"sort_digit_scan", "histogram",
       faulty<&stages::sort_digit_scan,
              [](const void* args) { ++args_of<SortDigitScanArgs>(args).histogram[255]; }>()},
      {"sort_pass", "keys_b", faulty<&stages::sort_pass, wrong_shift>()},
      {"sort_tile_counts", "sort_digits",
       faulty<&stages::sort_tile_counts,
              [](const void* args) { --args_of<SortScatterArgs>(args).tile_digits[0]; }>(),
       DeviceBuilder::ploc, false, two_sort_tiles},
      {"sort_tile_scan", "sort_digits",
       faulty<&stages::sort_tile_scan,
              [](const void* args) { ++args_of<SortTileScanArgs>(args).tile_digits[2047]; }>(),
       DeviceBuilder::ploc, false, two_sort_tiles},
      {"sort_scatter", "keys_a",
       faulty<&stages::sort_scatter,
              [](const void* args) {
                const auto a = args_of<SortScatterArgs>(args);
                ++a.keys_out[a.count];  // one past the end
              }>(),
       DeviceBuilder::ploc, false},
      {"ploc_leaves", "clusters_even",
       faulty<&stages::ploc_leaves,
              [](const void* args) {
                const auto a = args_of<PlocLeavesArgs>(args);
                a.clusters[a.triangle_count].height = 1;  // one past the end
              }>()},
      {"ploc_merge", "partners",
       faulty<&stages::ploc_merge,
              [](const void* args) { args_of<PlocMergeArgs>(args).partners[3] ^= 1; }>()},
      {"ploc_merge", "rounds",
       faulty<&stages::ploc_merge,
              [](const void* args) {
                const auto a = args_of<PlocMergeArgs>(args);
                ++a.rounds[a.round + 1].merged_before;
              }>()},
      {"ploc_finish", "nodes",
       faulty<&stages::ploc_finish,
              [](const void* args) { ++args_of<PlocFinishArgs>(args).nodes[0].height; }>()},
      {"hploc_build", "arrivals",
       faulty<&stages::hploc_build, [](const void* args) { ++args_of<HplocBuildArgs>(args).arrivals[7]; }>(),
       DeviceBuilder::hploc},
  };
}

TEST_F(Lockstep, NamesAPlantedFaultByStageAndSlot) {
  for (const StageFault& fault : stage_faults()) {
    const std::vector<Triangle> triangles = random_triangles(fault.triangles, 1);
    BuildOptions options;
    options.builder = fault.builder;
    options.lookback = fault.lookback;
    const auto difference = build_in_lockstep(triangles, options, [&](std::vector<Step>& steps) {
      for (Step& step : steps) {
        if (stage_of(step) && std::string_view(stage_of(step)->name) == fault.stage)
          dispatch_of(step)->stage = &fault.declaration;
      }
    });
    ASSERT_TRUE(difference) << fault.stage << ": not noticed";
    EXPECT_EQ(difference->stage, fault.stage);
    EXPECT_EQ(difference->slot, fault.slot) << "in " << fault.stage;
  }
}

}  // namespace
}  // namespace coppice
