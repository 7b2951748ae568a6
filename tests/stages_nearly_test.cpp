// What counts as nearly the same on a GPU has limits: a few roundings pass, anything more does not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "interface/trace.h"
#include "stages/nearly.h"
#include "stages/stages.h"

namespace coppice {
namespace {

template <class T>
NearlyEqual compared(Nearly like, const std::vector<T>& cpu, const std::vector<T>& gpu) {
  return compare_nearly(like, std::as_bytes(std::span(cpu)), std::as_bytes(std::span(gpu)));
}

float next(float x) { return std::nextafter(x, std::numeric_limits<float>::infinity()); }

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::vector<Hit> some_hits() {
  std::vector<Hit> hits;
  for (uint i = 0; i < 1000; ++i) {
    if (i % 4 == 0)
      hits.push_back({std::numeric_limits<float>::infinity(), NO_TRIANGLE, 0, 0});
    else
      hits.push_back({1 + static_cast<float>(i), i, 0.25f, 0.5f});
  }
  return hits;
}

// Whether the hits hold when this befalls the first `count` of them that hit.
template <class Spoil>
bool holds(std::size_t count, Spoil spoil) {
  const std::vector<Hit> cpu = some_hits();
  std::vector<Hit> gpu = cpu;
  for (Hit& hit : gpu) {
    if (hit.triangle != NO_TRIANGLE && count-- > 0) spoil(hit);
    if (count == 0) break;
  }
  return compared(Nearly::hits, cpu, gpu).holds();
}

TEST(Nearly, OneAnyHitOfAThousandMayBeTheOtherOneButNotTwoAndNoOtherWord) {
  std::vector<uint> cpu(1000);
  for (std::size_t i = 0; i < cpu.size(); i += 3) cpu[i] = 1;
  std::vector<uint> gpu = cpu;
  gpu[5] ^= 1;
  EXPECT_TRUE(compared(Nearly::any_hits, cpu, gpu).holds());
  gpu[6] ^= 1;
  EXPECT_FALSE(compared(Nearly::any_hits, cpu, gpu).holds());
  gpu = cpu;
  gpu[7] = 2;
  EXPECT_FALSE(compared(Nearly::any_hits, cpu, gpu).holds());
}

TEST(Nearly, CandidatesMayBeSomeRoundingsOffAndFewBeOthers) {
  std::vector<BoxCandidate> cpu;
  for (uint i = 0; i < 1000; ++i) cpu.push_back({i, 1 + static_cast<float>(i)});
  std::vector<BoxCandidate> gpu = cpu;
  for (BoxCandidate& candidate : gpu) candidate.t_enter = next(next(candidate.t_enter));
  EXPECT_TRUE(compared(Nearly::candidates, cpu, gpu).holds());
  for (std::size_t i = 0; i < 10; ++i) gpu[i].primitive += 1;
  EXPECT_TRUE(compared(Nearly::candidates, cpu, gpu).holds());
  gpu[10].t_enter *= 1.001f;
  EXPECT_FALSE(compared(Nearly::candidates, cpu, gpu).holds());
}

TEST(Nearly, OneCountOfCandidatesOfAThousandMayBeAnotherOne) {
  const std::vector<uint> cpu(1000, 5);
  std::vector<uint> gpu = cpu;
  gpu[5] = 4;
  EXPECT_TRUE(compared(Nearly::candidate_counts, cpu, gpu).holds());
  gpu[6] = 6;
  EXPECT_FALSE(compared(Nearly::candidate_counts, cpu, gpu).holds());
}

TEST(Nearly, HitsMayBeSomeRoundingsOff) {
  const auto some_ulps = [](Hit& hit) {
    hit.t = next(next(next(hit.t)));
    hit.u += 0.001f;
  };
  EXPECT_TRUE(holds(750, some_ulps));
}

TEST(Nearly, OneHitOfAThousandMayBeAnotherButNotTwo) {
  const auto missed = [](Hit& hit) { hit = {std::numeric_limits<float>::infinity(), NO_TRIANGLE, 0, 0}; };
  const auto farther = [](Hit& hit) { hit.t *= 1.001f; };
  const auto no_number = [](Hit& hit) { hit.t = nan; };
  const auto elsewhere = [](Hit& hit) { std::swap(hit.u, hit.v); };
  const auto other = [](Hit& hit) { hit = {hit.t * 2, hit.triangle + 1, hit.u, hit.v}; };
  EXPECT_TRUE(holds(1, missed) && holds(1, farther) && holds(1, elsewhere) && holds(1, other));
  EXPECT_FALSE(holds(2, missed));
  EXPECT_FALSE(holds(2, farther));
  EXPECT_FALSE(holds(2, no_number));
  EXPECT_FALSE(holds(2, elsewhere));
  EXPECT_FALSE(holds(2, other));
}

TEST(Nearly, OneHitOfAHundredMayBeOfAnotherTriangleAtTheSameDistance) {
  const auto tied = [](Hit& hit) { ++hit.triangle; };
  EXPECT_TRUE(holds(10, tied));
  EXPECT_FALSE(holds(11, tied));
}

TEST(Nearly, OfFewHitsNoneMayBeAnother) {
  const std::vector<Hit> cpu(99, Hit{1, 7, 0.25f, 0.25f});
  std::vector<Hit> gpu = cpu;
  gpu[40].t = 1.5f;
  const NearlyEqual found = compared(Nearly::hits, cpu, gpu);
  EXPECT_FALSE(found.holds());
  EXPECT_EQ(found.first, 40u);
}

TEST(Nearly, RaysDifferByRoundingsOfTheirLargestComponent) {
  const std::vector<Ray> cpu = {{{0, 0, 1}, 0, {1, 1e-7f, 0}, std::numeric_limits<float>::infinity()}};
  const auto with = [&](auto spoil) {
    std::vector<Ray> gpu = cpu;
    spoil(gpu[0]);
    return compared(Nearly::rays, cpu, gpu).holds();
  };
  EXPECT_TRUE(with([](Ray& ray) { ray.direction.y = -1e-7f; }));
  EXPECT_FALSE(with([](Ray& ray) { ray.direction.y = 1e-4f; }));
  EXPECT_FALSE(with([](Ray& ray) { ray.origin.x = 1e-3f; }));
  EXPECT_FALSE(with([](Ray& ray) { ray.direction.z = nan; }));
  EXPECT_FALSE(with([](Ray& ray) { ray.t_min = next(0); }));
  EXPECT_FALSE(with([](Ray& ray) { ray.t_max = 1e30f; }));
}

TEST(Nearly, CountersKeepTheirRaysAndNearlyTheRest) {
  const std::vector<TraceCounters> cpu = {{{10000, 1}, {5000, 1}, {200000, 1}, 0, 0}};
  const auto with = [&](auto spoil) {
    std::vector<TraceCounters> gpu = cpu;
    spoil(gpu[0]);
    return compared(Nearly::counters, cpu, gpu).holds();
  };
  EXPECT_TRUE(with([](TraceCounters& counters) { counters.hits.x += 5, counters.steps.x -= 60; }));
  EXPECT_FALSE(with([](TraceCounters& counters) { ++counters.rays.x; }));
  EXPECT_FALSE(with([](TraceCounters& counters) { counters.hits.y = 0; }));
  EXPECT_FALSE(with([](TraceCounters& counters) { ++counters.steps.y; }));
  EXPECT_FALSE(with([](TraceCounters& counters) { ++counters.padding1; }));
}

TEST(Nearly, ColoursAndPixels) {
  const std::vector<vec3> colours(1000, vec3(0.5f, 0, 2));
  std::vector<vec3> spoilt = colours;
  for (vec3& colour : spoilt) colour.y = 1e-6f;
  EXPECT_TRUE(compared(Nearly::radiance, colours, spoilt).holds());
  spoilt[3].x = nan;
  EXPECT_TRUE(compared(Nearly::radiance, colours, spoilt).holds());
  spoilt[4].x = 0.51f;
  EXPECT_FALSE(compared(Nearly::radiance, colours, spoilt).holds());

  const std::vector<uint> pixels(1000, 0xff804020);
  std::vector<uint> off = pixels;
  off[7] = 0xff814020;
  EXPECT_TRUE(compared(Nearly::image, pixels, off).holds());
  off[8] = 0xff80401f;
  EXPECT_FALSE(compared(Nearly::image, pixels, off).holds());
  off = pixels;
  off[7] = 0xff824020;
  EXPECT_FALSE(compared(Nearly::image, pixels, off).holds());
}

TEST(Nearly, SumsOfSquaredErrorsMayBeSomeRoundingsOff) {
  const std::vector<float> sums = {0, 1e-6f, 70, 65536};
  std::vector<float> off = {0, next(1e-6f), next(next(70)), 65536};
  EXPECT_TRUE(compared(Nearly::noise, sums, off).holds());
  off[2] = 70.1f;
  EXPECT_FALSE(compared(Nearly::noise, sums, off).holds());
  off = sums;
  off[0] = nan;
  EXPECT_FALSE(compared(Nearly::noise, sums, off).holds());
}

TEST(Nearly, SurfacesAndPathsByTheirFloatsAndEachWordOfTheRest) {
  const std::vector<SurfacePoint> surfaces(3, {{0, 1, 0}, 0.5f, {1, 2, 3}, 1, {0, 0, 0}, 0.25f});
  std::vector<SurfacePoint> off = surfaces;
  off[1].roughness = next(0.5f);
  EXPECT_TRUE(compared(Nearly::surfaces, surfaces, off).holds());
  off[0].transmission = off[1].transmission = 0.26f;  // one of a thousand, and part of one, may
  EXPECT_FALSE(compared(Nearly::surfaces, surfaces, off).holds());
  const std::vector<Path> paths(3, {{1, 2, 3}, 4, 5, 6, 7, 0});
  std::vector<Path> other = paths;
  other[1].pdf = next(5);
  EXPECT_TRUE(compared(Nearly::paths, paths, other).holds());
  for (uint Path::*const word : {&Path::pixel, &Path::flags, &Path::seed, &Path::padding}) {
    other = paths;
    other[0].*word ^= 1;
    other[1].*word ^= 1;
    EXPECT_FALSE(compared(Nearly::paths, paths, other).holds());
  }
}

TEST(Nearly, OnlyStagesThatDivideOrTakeRootsAreNearlyEqual) {
  for (const StageDeclaration* const stage : all_stages()) {
    const std::string_view name = stage->name;
    const bool traces = name.starts_with("trace_") && name != "trace_misses";  // which writes constants
    const bool may = traces || name == "camera_rays" || name == "bounce_rays" || name == "shade" ||
                     name == "resolve" || name == "shade_pixels" || name == "show" || name == "shadow_rays" ||
                     name == "noise_sum" || name == "noise_marks" || name == "shade_lights" ||
                     name == "texture_hits" || name == "occlusion_rays" || name == "path_surfaces" ||
                     name == "path_lights" || name == "path_bounce" || name == "path_fog";
    EXPECT_EQ(!stage->nearly.empty(), may) << name;
  }
}

TEST(Nearly, RefusesASlotThatHoldsSomethingElse) {
  const std::vector<uint> words(3);
  EXPECT_THROW(compared(Nearly::hits, words, words), std::logic_error);
}

}  // namespace
}  // namespace coppice
