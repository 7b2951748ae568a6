// The bytes that traces and pictures move by their models, against numbers worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "measure/traffic.h"
#include "pipeline/build_plan.h"
#include "pipeline/trace_any.h"
#include "pipeline/trace_pieces.h"
#include "pipeline/wide_plan.h"
#include "stages/stages.h"

namespace coppice {
namespace {

constexpr std::array<std::uint64_t, 4> nowhere{};
// Of 2,000 rays 500 hit something; each step of a ray is kept.
TEST(Traffic, OfWhatIsShown) {
  const auto bytes_of_view = [](uint view, const char* stage) {
    Layout layout;
    const TreeSlots tree = plan_tree(layout, 100, 199);
    TraceOptions options{.width = 40, .height = 50, .show = view};
    const TracePlan plan = plan_trace(layout, tree, 1, options);
    Chain chain(nowhere);
    append_trace(chain, tree, plan);
    TraceCounters counters{};
    counters.rays.x = 2000;
    counters.hits.x = 500;
    counters.steps.x = 30000;
    for (const Step& step : chain.steps()) {
      if (stage_of(step) && std::string_view(stage_of(step)->name) == stage)
        return modelled_bytes(step, counts_of_trace(counters));
    }
    return std::uint64_t{0};
  };
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "show"), 2000u * (4 + 12));
  EXPECT_EQ(bytes_of_view(SHOW_STEPS, "show"), 2000u * (4 + 12));
  EXPECT_EQ(bytes_of_view(SHOW_DEPTH, "show"), 2000u * (4 + 12) + 500 * 4);
  EXPECT_EQ(bytes_of_view(SHOW_NORMALS, "show"), 2000u * (4 + 12) + 500 * 36);
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "shade"), 0u);
  EXPECT_EQ(bytes_of_view(SHOW_IDS, "trace_closest"), 2000u * 64 + 64 * 30000 + 500 * 36);
  EXPECT_EQ(bytes_of_view(SHOW_STEPS, "trace_closest"), 2000u * 68 + 64 * 30000 + 500 * 36);
}

TEST(Traffic, OfAPictureOfOneSample) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan = plan_trace(layout, tree, 1, {.width = 40, .height = 25});
  Chain chain(nowhere);
  append_trace(chain, tree, plan);
  TraceCounters counters{};
  counters.rays.x = 1000;
  counters.hits.x = 250;
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts_of_trace(counters));
  }
  EXPECT_EQ(bytes["shade_pixels"], 1000u * 8 + 250 * 64);
  EXPECT_FALSE(bytes.contains("shade") || bytes.contains("resolve"));
}

// 1,000 rays, of which 250 hit something; of the 200 shadow rays of two lights 40 are blocked.
TEST(Traffic, OfLightsAndShadows) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan =
      plan_trace(layout, tree, 1, {.width = 40, .height = 25, .lights = {.lights = 3, .shadows = 2}});
  Chain chain(nowhere);
  append_trace(chain, tree, plan);
  RunCounts counts;
  counts.rays = 1000, counts.hits = 250, counts.steps = 4000;
  counts.shadow = {2000, 200, 40, 3000};
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["shadow_marks"], 2u * (1000 * 20 + 250 * 76));
  EXPECT_EQ(bytes["shadow_rays"], 2u * 1000 * 8 + 200 * 96);
  EXPECT_EQ(bytes["trace_any"], 200u * 36 + 3000 * 64 + 40 * 36);
  const std::uint64_t plain = 1000 * 4 + 250 * 112;
  EXPECT_EQ(bytes["shade_lights"], plain + 2 * (1000 * 4 + 250 * 4) + 200 * 8 + 160 * 112);
}

// 1,000 rays, of which 250 hit something and have an occlusion ray; 50 of these are blocked.
TEST(Traffic, OfAmbientOcclusion) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan =
      plan_trace(layout, tree, 1, {.width = 40, .height = 25, .lights = {.occlusion = true}});
  Chain chain(nowhere);
  append_trace(chain, tree, plan);
  RunCounts counts;
  counts.rays = 1000, counts.hits = 250, counts.steps = 4000;
  counts.occlusion = {1000, 250, 50, 2000};
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  EXPECT_EQ(bytes["occlusion_marks"], 1000u * 8 + 250 * 28);
  EXPECT_EQ(bytes["occlusion_rays"], 1000u * 8 + 250 * 96);
  EXPECT_EQ(bytes["trace_any"], 250u * 36 + 2000 * 64 + 50 * 36);
  EXPECT_EQ(bytes["shade_ambient"], 1000u * 4 + 250 * 8 + 200 * 56);
}

// By stage, of a picture of 1,000 rays, of which 250 hit something.
std::map<std::string, std::uint64_t> bytes_of_picture(TraceOptions options,
                                                      const RunCounts::Secondary& shadow = {}) {
  options.width = 40;
  options.height = 25;
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  const TracePlan plan = plan_trace(layout, tree, 1, options);
  Chain chain(nowhere);
  append_trace(chain, tree, plan);
  RunCounts counts;
  counts.rays = 1000, counts.hits = 250, counts.steps = 6400;
  counts.shadow = shadow;
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts);
  }
  return bytes;
}

TEST(Traffic, OfTextures) {
  auto bytes = bytes_of_picture({.textures = {.textures = 1, .texels = 64}});
  // Of a hit: the rest of it 12, direction 12, triangle 36, material 4 + 36 + 8, header 48, texels 32,
  // corners 64, and what is written 24.
  EXPECT_EQ(bytes["texture_hits"], 1000u * 4 + 250 * 276);
}

// It is met by the rays that hit nothing.
TEST(Traffic, OfEnvironments) {
  const auto bytes_of = [](std::uint32_t side) {
    return bytes_of_picture(
        {.paths = {.follows = true, .choices = 1, .environment_side = side}})["path_surfaces"];
  };
  EXPECT_EQ(bytes_of(0), 1000u * 84 + 250 * 164);
  EXPECT_EQ(bytes_of(16), 1000u * 84 + 250 * 164 + 750 * 112);
}

// Rays to lights are as many, from surfaces and from fog together.
TEST(Traffic, OfFog) {
  const auto bytes_of = [](bool fog) {
    const std::uint64_t could_be = fog ? 2000 : 1000;
    return bytes_of_picture({.paths = {.follows = true, .choices = 1, .shadows = true, .fog = fog}},
                            {could_be, 600, 200, 3000});
  };
  auto fog = bytes_of(true), clear = bytes_of(false);
  EXPECT_EQ(fog["path_fog"], 1000u * 4 + 1000 * 40);
  EXPECT_FALSE(clear.contains("path_fog"));
  EXPECT_EQ(clear["path_light_add"], 1000u * 4 + 600 * 8 + 400 * 40);
  EXPECT_EQ(fog["path_light_add"], clear["path_light_add"] + 1000 * 4) << "twice through the queue";
  EXPECT_EQ(clear["path_lights"] - fog["path_lights"], 300u * 44) << "half of them";
}

// The same as without, and of each hit the word of its triangle.
TEST(Traffic, OfAlpha) {
  const auto bytes_of = [](AlphaCounts alpha, Walk walk) {
    return bytes_of_picture({.walk = walk, .lights = {.lights = 1, .shadows = 1}, .alpha = alpha},
                            {1000, 200, 40, 3000});
  };
  for (const auto& [walk, closest, any] :
       {std::tuple{Walk::binary, "trace_closest", "trace_any"},
        std::tuple{Walk::wide_packets, "trace_wide", "trace_wide_any"},
        std::tuple{Walk::wide_single, "trace_wide_single", "trace_wide_any"}}) {
    auto with = bytes_of({1, 16}, walk), without = bytes_of({}, walk);
    EXPECT_EQ(with[closest + std::string("_alpha")], without[closest] + 250 * 4);
    EXPECT_EQ(with[any + std::string("_alpha")], without[any] + 40 * 4);
    EXPECT_FALSE(with.contains(closest) || with.contains(any));
  }
}

TEST(Traffic, OfATraceOfTwoSamples) {
  Layout layout;
  const TreeSlots tree = plan_tree(layout, 100, 199);
  TraceOptions options;
  options.width = 40;
  options.height = 25;
  options.samples = 2;
  const TracePlan plan = plan_trace(layout, tree, 1, options);
  Chain chain(nowhere);
  append_trace(chain, tree, plan);
  append_bounce(chain, tree, plan, plan, 1000, 1);
  TraceCounters counters{};
  counters.rays.x = 2000;
  counters.hits.x = 500;
  counters.steps = {30000, 1};
  std::map<std::string, std::uint64_t> bytes;
  for (const Step& step : chain.steps()) {
    if (stage_of(step)) bytes[stage_of(step)->name] += modelled_bytes(step, counts_of_trace(counters));
  }
  EXPECT_EQ(bytes["camera_rays"], 2000u * 48);
  EXPECT_EQ(bytes["trace_closest"], 2000u * 64 + 64 * ((std::uint64_t{1} << 32) + 30000) + 500 * 36);
  EXPECT_EQ(bytes["shade"], 2000u * 48 + 500 * 64 + 1000 * 12);
  EXPECT_EQ(bytes["resolve"], 16000u);
  EXPECT_EQ(bytes["bounce_rays"], 1000u * 96 + 250 * 36);
}

TEST(Traffic, OfAnyHitsAndCandidates) {
  Layout layout;
  TreeSlots tree = plan_tree(layout, 100, 199);
  plan_wide(layout, tree);
  AnyHitSlots any = plan_any_hits(layout, 1000);
  const CandidateSlots candidates = plan_candidates(layout, 1000, 4);
  TraceCounters counters{};
  counters.rays.x = 1000;
  counters.hits.x = 500;
  counters.steps.x = 30000;
  Chain chain(nowhere);
  TraceOptions options;
  append_any_hits(chain, tree, any, 1000, options);
  options.walk = Walk::wide_single;
  append_any_hits(chain, tree, any, 1000, options);
  append_candidates(chain, tree, candidates, 1000, options);
  const auto bytes = [&](std::size_t step) {
    return modelled_bytes(chain.steps()[step], counts_of_trace(counters));
  };
  EXPECT_EQ(bytes(0), 1000u * 36 + 30000 * 64 + 500 * 36);
  EXPECT_EQ(bytes(1), 1000u * 36 + 30000 * 96 + 500 * 36);
  EXPECT_EQ(bytes(2), 1000u * 36 + 30000 * 64 + 500 * 8);
}

}  // namespace
}  // namespace coppice
