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

bool is_stage(const Step& step, std::string_view name) {
  return stage_of(step) && stage_of(step)->name == name;
}

template <class Args>
Args step_args_of(const Step& step) {
  Args args;
  std::memcpy(&args, dispatch_of(step)->args.data(), sizeof args);
  return args;
}

bool uses_lookback(const std::vector<Step>& steps) {
  return std::any_of(steps.begin(), steps.end(), [](const Step& step) {
    return is_stage(step, "ploc_merge") && step_args_of<PlocMergeArgs>(step).lookback != 0;
  });
}

// Every build ends well, with a tree that is valid and not the one asked for.
void search_too_near(std::vector<Step>& steps) {
  for (Step& step : steps) {
    if (is_stage(step, "ploc_merge") || is_stage(step, "ploc_tile_counts"))
      dispatch_of(step)->constants.words.at(3) = 1;
  }
}

using Fault = std::function<void(std::vector<Step>&)>;

DeviceUse builds_by(DeviceBuilder builder, const Variants& variants = {}) {
  DeviceUse use;
  use.build.builder = builder;
  use.build.variants = variants;
  return use;
}

DeviceUse traces_by(Walk walk) {
  DeviceUse use;
  use.builds = false;
  use.traces = {test_trace_options(1, 1)};
  use.traces[0].walk = walk;
  return use;
}

// What objects of the library do beside.
DeviceUse library_use(Walk walk = Walk::binary) {
  DeviceUse use = traces_by(walk);
  use.wide = use.refits = use.inputs = use.batches = use.sorts = use.scans = use.every_ray = true;
  return use;
}

// The line with which a device is refused; empty where it is not.
std::string refusal(const DeviceUse& use, const Fault& fault, Device& device = test_device()) {
  try {
    check_device(device, use, fault);
    return "";
  } catch (const DeviceError& error) {
    return error.what();
  }
}

bool says(const std::string& refusal, const std::string& what) {
  return refusal.find(test_device().properties().name) != std::string::npos &&
         refusal.find(what + " in the self-check; it is not used") != std::string::npos;
}

TEST_F(SelfCheck, PassesOnTheTestDevice) {
  EXPECT_TRUE(check_device(test_device(), {}));
  EXPECT_TRUE(check_device(test_device(),
                           builds_by(DeviceBuilder::ploc, default_variants(test_device().properties()))));
  for (const DeviceBuilder builder : {DeviceBuilder::hploc, DeviceBuilder::lbvh}) {
    DeviceUse use = builds_by(builder);
    use.traces = {test_trace_options(1, 1)};
    use.traces[0].walk = Walk::wide_packets;
    EXPECT_TRUE(check_device(test_device(), use));
  }
  for (const DeviceUse& use :
       {traces_by(Walk::binary), traces_by(Walk::wide_packets), traces_by(Walk::wide_single)})
    EXPECT_TRUE(check_device(test_device(), use));
  EXPECT_TRUE(check_device(test_device(), traces_by(Walk::brute_force)));
}

TEST_F(SelfCheck, DoesWithoutLookbackWhereItGivesAnotherTree) {
  EXPECT_FALSE(check_device(test_device(), {}, [](std::vector<Step>& steps) {
    if (uses_lookback(steps)) search_too_near(steps);
  }));
}

TEST_F(SelfCheck, DoesWithoutLookbackWhereItEndsWithAnError) {
  bool stressed = false;
  EXPECT_FALSE(check_device(test_device(), {}, [&](std::vector<Step>& steps) {
    for (Step& step : steps) {
      if (!is_stage(step, "ploc_merge") || step_args_of<PlocMergeArgs>(step).lookback == 0) continue;
      KernelConstants& constants = dispatch_of(step)->constants;
      constants.words[0] = constants.words[1] = 0;
      constants.words[2] = 1u << LOOKBACK_SILENT_SHIFT;  // no poll, no fallback, a silent tile
      stressed = true;
    }
  }));
  EXPECT_TRUE(stressed);
}

TEST_F(SelfCheck, RefusesByNameADeviceThatIsWrongEitherWay) {
  EXPECT_TRUE(says(refusal({}, search_too_near), "computes a wrong tree"));
}

TEST_F(SelfCheck, RefusesADeviceWhoseSubgroupsDoNotMeet) {
  const Fault nobody_arrives = [](std::vector<Step>& steps) {
    for (Step& step : steps) {
      if (is_stage(step, "hploc_build")) dispatch_of(step)->groups.x /= 2;  // half of the tiles never come
    }
  };
  EXPECT_TRUE(says(refusal(builds_by(DeviceBuilder::hploc), nobody_arrives), "computes a wrong tree"));
}

// A tracer that ends too early, and one that does not run.
TEST_F(SelfCheck, RefusesADeviceByTheTracerThatIsGoingToRun) {
  const Fault one_turn = [](std::vector<Step>& steps) {
    for (Step& step : steps) {
      if (stage_of(step) && std::string_view(stage_of(step)->name).starts_with("trace_"))
        dispatch_of(step)->constants.words.at(0) = 1;
    }
  };
  const Fault half = [](std::vector<Step>& steps) { dispatch_of(steps.back())->groups.x /= 2; };
  for (const DeviceUse& use :
       {traces_by(Walk::binary), traces_by(Walk::wide_packets), traces_by(Walk::wide_single)}) {
    EXPECT_TRUE(says(refusal(use, one_turn), "finds wrong hits"));
    EXPECT_TRUE(says(refusal(use, half), "finds wrong hits"));
  }
}

TEST_F(SelfCheck, PassesWithAllThatTheLibraryDoes) {
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    for (const bool values : {false, true}) {
      DeviceUse use = library_use(walk);
      use.sorts_values = values;
      use.build.variants = default_variants(test_device().properties());
      EXPECT_TRUE(check_device(test_device(), use));
    }
  }
  Device like_a_gpu({"", false, true});
  EXPECT_TRUE(check_device(like_a_gpu, library_use()));
}

DeviceUse use_of_what_moves() {
  DeviceUse use;
  use.builds = false;
  use.vertices = use.instances = true;
  return use;
}

TEST_F(SelfCheck, PassesWithVerticesAndInstancesThatMove) {
  for (const DeviceBuilder builder : {DeviceBuilder::ploc, DeviceBuilder::hploc}) {
    DeviceUse use = use_of_what_moves();
    use.build.builder = builder;
    EXPECT_TRUE(check_device(test_device(), use));
  }
  Device like_a_gpu({"", false, true});
  EXPECT_TRUE(check_device(like_a_gpu, use_of_what_moves()));
}

// Every stage of these, where its last workgroup does not come.
TEST_F(SelfCheck, RefusesADeviceByWhatMoves) {
  const std::pair<const char*, const char*> stages[] = {
      {"vertex_sequence", "moves vertices wrong"}, {"vertex_morph", "moves vertices wrong"},
      {"vertex_deform", "moves vertices wrong"},   {"vertex_pose", "moves vertices wrong"},
      {"move_instances", "instances wrong"},       {"instance_boxes", "instances wrong"},
      {"trace_instances", "finds wrong hits"},     {"place_hits", "instances wrong"}};
  for (const auto& [stage, wrong] : stages) {
    const Fault all_but_one = [name = stage](std::vector<Step>& steps) {
      for (Step& step : steps) {
        if (is_stage(step, name)) --dispatch_of(step)->groups.x;
      }
    };
    EXPECT_TRUE(says(refusal(use_of_what_moves(), all_but_one), wrong)) << stage;
  }
}

// Every stage that only the library runs, where it does half of its work.
TEST_F(SelfCheck, RefusesADeviceByWhatTheLibraryDoes) {
  const std::pair<const char*, const char*> stages[] = {{"wide_collapse_rest", "computes a wrong tree"},
                                                        {"wide_sizes_rest", "computes a wrong tree"},
                                                        {"gather_triangles", "computes a wrong tree"},
                                                        {"box_bounds", "computes a wrong tree"},
                                                        {"refit_absent", "refits a tree wrong"},
                                                        {"refit_keys", "refits a tree wrong"},
                                                        {"refit_boxes", "refits a tree wrong"},
                                                        {"refit_appeared", "refits a tree wrong"},
                                                        {"tree_areas", "refits a tree wrong"},
                                                        {"batch_build", "computes a wrong tree"},
                                                        {"trace_misses", "finds wrong hits"},
                                                        {"trace_any", "finds wrong hits"},
                                                        {"trace_candidates", "finds wrong hits"},
                                                        {"sort_scatter", "sorts wrong"},
                                                        {"prefix_scan", "computes wrong prefix sums"}};
  for (const auto& [stage, wrong] : stages) {
    std::size_t spoilt = 0;
    const Fault half = [&, name = stage](std::vector<Step>& steps) {
      for (Step& step : steps) {
        if (!is_stage(step, name)) continue;
        dispatch_of(step)->groups.x /= 2;
        dispatch_of(step)->indirect.reset();
        ++spoilt;
      }
    };
    DeviceUse use = library_use();
    use.build.variants.sort = SORT_SCAN_8;
    use.wide = true;
    const std::string why = refusal(use, half);
    if (spoilt == 0 && std::string_view(stage).ends_with("_rest")) {
      EXPECT_NE(test_device().properties().loop_turn_limit, 0u) << stage;
      continue;
    }
    EXPECT_TRUE(says(why, wrong)) << stage;
    EXPECT_GT(spoilt, 0u) << stage;
  }
}

// Where hits need be only nearly the same.
TEST_F(SelfCheck, RefusesAGpuByItsTracer) {
  Device device({"", false, true});
  EXPECT_EQ(refusal(traces_by(Walk::wide_packets), {}, device), "");
  const Fault half = [](std::vector<Step>& steps) { dispatch_of(steps.back())->groups.x /= 2; };
  EXPECT_TRUE(says(refusal(traces_by(Walk::wide_packets), half, device), "finds wrong hits"));
}

}  // namespace
}  // namespace coppice
