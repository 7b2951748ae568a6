// Signals end work between two pieces, and only where a guard says so.
#include <gtest/gtest.h>

#include "pipeline/interruption.h"

namespace coppice {
namespace {

TEST(Interruption, ASignalIsNotedAndThrownOnce) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const InterruptionGuard guard;
    throw_if_interrupted();
    raise(signal);
    try {
      throw_if_interrupted();
      ADD_FAILURE() << signal;
    } catch (const Interrupted& interrupted) {
      EXPECT_EQ(interrupted.signal, signal);
    }
    throw_if_interrupted();
  }
}

TEST(Interruption, TheOutermostGuardCounts) {
  const InterruptionGuard outer;
  { const InterruptionGuard inner; }
  raise(SIGINT);
  EXPECT_THROW(throw_if_interrupted(), Interrupted);
}

TEST(Interruption, IgnoredSignalsStayIgnored) {
  const auto former = std::signal(SIGINT, SIG_IGN);
  {
    const InterruptionGuard guard;
    raise(SIGINT);
    EXPECT_NO_THROW(throw_if_interrupted());
  }
  std::signal(SIGINT, former);
}

TEST(InterruptionDeathTest, WithoutAGuardAndTheSecondTimeTheProgramEnds) {
  EXPECT_EXIT(raise(SIGTERM), testing::KilledBySignal(SIGTERM), "");
  EXPECT_EXIT(
      {
        const InterruptionGuard guard;
        raise(SIGINT);
        raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptionDeathTest, ASignalThatNothingAskedForEndsTheProgramAfterTheGuard) {
  EXPECT_EXIT(
      {
        const InterruptionGuard guard;
        raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace coppice
