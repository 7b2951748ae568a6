// A device that miscomputes is told apart before any result is shown: it runs without lookback where that is
// what fails, and is refused by name where nothing helps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "interface/lookback.h"
#include "interface/ploc.h"
#include "pipeline/self_check.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class SelfCheck : public DeviceTest {};

bool is_stage(const Step& step, std::string_view name) { return step.stage && step.stage->name == name; }

template <class Args>
Args args_of(const Step& step) {
  Args args;
  std::memcpy(&args, step.args.data(), sizeof args);
  return args;
}

bool uses_lookback(const std::vector<Step>& steps) {
  return std::any_of(steps.begin(), steps.end(), [](const Step& step) {
    return is_stage(step, "ploc_merge") && args_of<PlocMergeArgs>(step).lookback != 0;
  });
}

// Every build ends well, with a tree that is valid and not the one asked for.
void search_too_near(std::vector<Step>& steps) {
  for (Step& step : steps) {
    if (is_stage(step, "ploc_merge") || is_stage(step, "ploc_tile_counts")) step.specialization.at(3) = 1;
  }
}

TEST_F(SelfCheck, PassesOnTheTestDevice) {
  EXPECT_TRUE(check_lookback(test_device(), {}));
  EXPECT_TRUE(check_lookback(test_device(), default_variants(test_device().properties())));
}

TEST_F(SelfCheck, DoesWithoutLookbackWhereItGivesAnotherTree) {
  EXPECT_FALSE(check_lookback(test_device(), {}, [](std::vector<Step>& steps) {
    if (uses_lookback(steps)) search_too_near(steps);
  }));
}

TEST_F(SelfCheck, DoesWithoutLookbackWhereItEndsWithAnError) {
  bool stressed = false;
  EXPECT_FALSE(check_lookback(test_device(), {}, [&](std::vector<Step>& steps) {
    for (Step& step : steps) {
      if (!is_stage(step, "ploc_merge") || args_of<PlocMergeArgs>(step).lookback == 0) continue;
      step.specialization[0] = step.specialization[1] = 0;
      step.specialization[2] = 1u << LOOKBACK_SILENT_SHIFT;  // no poll, no fallback, a silent tile
      stressed = true;
    }
  }));
  EXPECT_TRUE(stressed);
}

TEST_F(SelfCheck, RefusesByNameADeviceThatIsWrongEitherWay) {
  try {
    check_lookback(test_device(), {}, search_too_near);
    FAIL() << "not refused";
  } catch (const DeviceError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(test_device().properties().name), std::string::npos) << what;
    EXPECT_NE(what.find("computes a wrong tree in the self-check; it is not used"), std::string::npos)
        << what;
  }
}

}  // namespace
}  // namespace coppice
