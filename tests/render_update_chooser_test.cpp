// When a moving scene's tree is built anew: the rule of docs/frames.md, against costs that are known.
#include <gtest/gtest.h>

#include <deque>
#include <functional>

#include "render/update_chooser.h"

namespace coppice {
namespace {

// A scene in which a build takes 20 ms, a refit 2 ms, and a step of its rays 1 us.
struct Costs {
  double build_ms = 20, refit_ms = 2;
  std::function<double(int)> trace_ms;  // so many frames after the last build
};

struct Total {
  double ms = 0;
  int builds = 0, refits = 0;
};

// Frames of which the outcome is known when `under_way` more have been decided on.
Total run(Update update, const Costs& costs, int frames, std::size_t under_way) {
  UpdateChooser chooser(update);
  Total total;
  int since_build = 0;
  std::deque<UpdateChooser::Frame> waiting;
  for (int frame = 0; frame < frames; ++frame) {
    if (waiting.size() == under_way) {
      chooser.note(waiting.front());
      waiting.pop_front();
    }
    const bool refits = chooser.next_refits();
    since_build = refits ? since_build + 1 : 0;
    const double trace_ms = costs.trace_ms(since_build);
    waiting.push_back({.rebuilt = !refits,
                       .update_ms = refits ? costs.refit_ms : costs.build_ms,
                       .trace_ms = trace_ms,
                       .steps = static_cast<std::uint64_t>(trace_ms * 1000)});
    total.ms += waiting.back().update_ms + trace_ms;
    ++(refits ? total.refits : total.builds);
  }
  return total;
}

class Chooser : public testing::TestWithParam<std::size_t> {};

TEST_P(Chooser, FixedChoicesAreKept) {
  const Costs still{.trace_ms = [](int) { return 10.0; }};
  EXPECT_EQ(run(Update::rebuild, still, 100, GetParam()).refits, 0);
  EXPECT_EQ(run(Update::refit, still, 100, GetParam()).builds, 1);
}

TEST_P(Chooser, NothingThatStandsStillIsBuiltAgain) {
  const Costs still{.trace_ms = [](int) { return 10.0; }};
  EXPECT_EQ(run(Update::automatic, still, 500, GetParam()).builds, 1);
}

// Of a trace that gets slower by g each frame the best cycle has sqrt(2 * 18 / g) frames.
TEST_P(Chooser, WhatGetsSlowlyWorseIsBuiltNowAndThen) {
  for (const double growth : {0.01, 0.1, 0.5, 2.0}) {
    const Costs costs{.trace_ms = [=](int since) { return 10.0 + growth * since; }};
    const Total chosen = run(Update::automatic, costs, 2000, GetParam());
    double best = 1e300;
    for (int cycle = 1; cycle <= 2000; ++cycle) {
      double ms = costs.build_ms - costs.refit_ms;
      for (int since = 0; since < cycle; ++since) ms += costs.refit_ms + costs.trace_ms(since);
      best = std::min(best, ms / cycle * 2000);
    }
    EXPECT_LT(chosen.ms, 1.05 * best) << growth;
    EXPECT_LT(chosen.ms, run(Update::rebuild, costs, 2000, GetParam()).ms) << growth;
    EXPECT_LT(chosen.ms, run(Update::refit, costs, 2000, GetParam()).ms) << growth;
  }
}

// What rays meet more of comes of the scene, and a build takes none of it back.
TEST_P(Chooser, BuildsThatTakeNothingBackAreRare) {
  for (const double growth : {0.01, 0.05, 0.2}) {
    int frame = 0;
    const Costs costs{.trace_ms = [&](int) { return 10.0 + growth * (frame++ % 300); }};
    const double refits_only = run(Update::refit, costs, 3000, GetParam()).ms;
    frame = 0;
    EXPECT_LT(run(Update::automatic, costs, 3000, GetParam()).ms, 1.02 * refits_only) << growth;
  }
}

TEST_P(Chooser, WhatFallsApartAtOnceIsBuiltNearlyAlways) {
  const Costs costs{.trace_ms = [](int since) { return since == 0 ? 10.0 : 10.0 + 60.0 * since; }};
  const Total chosen = run(Update::automatic, costs, 2000, GetParam());
  EXPECT_LT(chosen.ms, 1.25 * run(Update::rebuild, costs, 2000, GetParam()).ms);
  EXPECT_GT(chosen.refits, 0) << "it has to try";
}

// Half of the time it does not pay, half of the time it does.
TEST_P(Chooser, ItComesBackToRefitsWhenTheyPayAgain) {
  int frame = 0;
  const Costs costs{.trace_ms = [&](int since) { return frame++ % 1000 < 500 ? 10.0 + 60.0 * since : 10.0; }};
  const Total chosen = run(Update::automatic, costs, 4000, GetParam());
  EXPECT_GT(chosen.refits, 1400);
}

TEST_P(Chooser, TrianglesThatAppearEveryFrameEndTheTrying) {
  UpdateChooser chooser(Update::automatic);
  int vain = 0;
  for (int frame = 0; frame < 1000; ++frame) {
    const bool refits = chooser.next_refits();
    vain += refits;
    chooser.note({true, refits, 20, 10, 10000});
  }
  EXPECT_LT(vain, 40);
}

INSTANTIATE_TEST_SUITE_P(FramesUnderWay, Chooser, testing::Values(1, 2, 3));

}  // namespace
}  // namespace coppice
