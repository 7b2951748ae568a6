#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/exact_hit.h"
#include "analysis/judge_hits.h"

namespace coppice {

// Rays, what was reported for them, and the scene: what an example is taken from.
struct TracedBatch {
  std::span<const Node> nodes;
  std::span<const Triangle> triangles;
  std::span<const Ray> rays;
  std::span<const Hit> hits;
};

// A ray that a trace failed at, with all that it takes to see why.
struct RayExample {
  std::string_view failure;  // one of the constants below
  std::string_view kind;     // of the ray
  std::uint64_t index = 0;   // among the rays of its kind
  Ray ray{};
  Hit hit{};          // what was reported
  ExactHit expected;  // the closest hit in exact arithmetic
  std::string reason;
};

inline constexpr std::string_view FALSE_HIT = "false hit", MISSED = "missed", LEAK = "leak",
                                  OTHER_BITS = "other bits", MISSED_AT_EDGE = "missed at an edge";
// The gravest first; the last is none where a surface ends.
inline constexpr std::array FAILURES = {FALSE_HIT, MISSED, LEAK, OTHER_BITS, MISSED_AT_EDGE};

// The first of each kind of failure, in the order of FAILURES. `twins` are the hits of the twins. Of rays
// that must all hit, `is_closed`, a miss is a leak.
std::vector<RayExample> examples_of(const TracedBatch& batch, const HitVerdicts& verdicts,
                                    std::span<const Hit> twins, std::string_view kind, bool is_closed);

// The first leak of rays that must all hit.
RayExample example_of_leak(const TracedBatch& batch, std::string_view kind);

// On one line, floats in full.
std::string described(const RayExample& example);

}  // namespace coppice
