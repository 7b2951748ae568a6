// Which steps may overlap: what depends on each other stays apart, and what does not may be run in any order.
#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/check_chain.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/cpu_executor.h"
#include "stages/hazards.h"
#include "stages/stages.h"

namespace coppice {
namespace {

TEST(AddressArgs, SayWhatIsWritten) {
  const std::span<const AddressArg> pass = stages::sort_pass.addresses;
  const std::vector<bool> written = {false, false, true, true, false, true, true, true, false};
  ASSERT_EQ(pass.size(), written.size());
  for (std::size_t i = 0; i < pass.size(); ++i) {
    EXPECT_EQ(pass[i].offset, 8 * i);
    EXPECT_EQ(pass[i].written, written[i]) << i;
  }
}

// Copies between four slots of 1024 quads each.
class HazardsTest : public testing::Test {
 protected:
  void copy(const Slot<uvec4>& source, const Slot<uvec4>& target, std::uint64_t first_source = 0,
            std::uint64_t first_target = 0) {
    chain.run(stages::copy_words, {chain.at(source, first_source), chain.at(target, first_target), 16, 0},
              {1, 1, 1});
  }

  // A letter a step: whether a barrier precedes it.
  std::string barriers(Hazards::Overlap overlap = Hazards::Overlap::steps) const {
    Hazards hazards(AddressMap(layout, executor.block_addresses()), overlap);
    std::string found;
    for (const Step& step : chain.steps()) found += hazards.needs_barrier(step) ? '|' : '.';
    return found;
  }

  Layout layout;
  Slot<uvec4> a = layout.add<uvec4>("a", 1024), b = layout.add<uvec4>("b", 1024),
              c = layout.add<uvec4>("c", 1024), d = layout.add<uvec4>("d", 1024);
  CpuExecutor executor{layout};
  Chain chain = executor.chain();
};

TEST_F(HazardsTest, WhatIsReadAfterItIsWritten) {
  copy(a, b);
  copy(b, c);
  EXPECT_EQ(barriers(), "||");
}

TEST_F(HazardsTest, WhatIsWrittenAfterItIsRead) {
  copy(a, b);
  copy(c, a);
  EXPECT_EQ(barriers(), "||");
}

TEST_F(HazardsTest, WhatIsWrittenTwice) {
  copy(a, c);
  copy(b, c);
  EXPECT_EQ(barriers(), "||");
}

TEST_F(HazardsTest, WhatIsReadTwiceOverlaps) {
  copy(a, b);
  copy(a, c);
  copy(a, d);
  EXPECT_EQ(barriers(), "|..");
}

TEST_F(HazardsTest, OnlyStepsBehindTheLastBarrierCount) {
  copy(a, b);
  copy(b, c);
  copy(a, d);
  copy(d, a);
  EXPECT_EQ(barriers(), "||.|");
}

TEST_F(HazardsTest, PartsOfASlotCountUpToItsEnd) {
  copy(a, b, 0, 512);
  copy(b, c, 100, 0);
  copy(c, d, 1000, 0);
  EXPECT_EQ(barriers(), "|||");
}

TEST_F(HazardsTest, ClearsAreWrites) {
  copy(a, b);
  chain.clear(a);
  chain.clear(c);
  copy(d, c);
  EXPECT_EQ(barriers(), "||.|");
}

TEST_F(HazardsTest, GroupsAreRead) {
  copy(a, b);
  chain.run_indirect(stages::copy_words, {chain.at(c), chain.at(d), 16, 0}, b.place);
  EXPECT_EQ(barriers(), "||");
}

TEST_F(HazardsTest, BehindAMarkABarrier) {
  copy(a, b);
  chain.mark();
  copy(c, d);
  EXPECT_EQ(barriers(), "|.|");
}

TEST_F(HazardsTest, WhatIsTimedStandsApart) {
  copy(a, b);
  copy(a, c);
  chain.clear(d);
  chain.clear(b);
  copy(a, c);
  EXPECT_EQ(barriers(Hazards::Overlap::clears), "|||.|");
}

TEST_F(HazardsTest, WhatNobodyKnowsReachesToTheEnd) {
  chain.run(stages::copy_words, {{a.place.offset + 16}, chain.at(b), 16, 0}, {1, 1, 1});
  copy(c, d);
  EXPECT_EQ(barriers(), "||");
}

// Of a caller, who gives no guard behind his keys.
TEST(AddressMap, AnArrayRightBehindAnother) {
  Layout layout = Layout::apart(std::uint64_t{1} << 30);
  const auto keys = layout.add<uint>("keys", 64, Memory::keys);
  const auto values = layout.add<uint>("values", 128, Memory::values);
  std::array<std::uint64_t, memory_kinds> addresses{};
  addresses[keys.place.block] = 0x1000;
  addresses[values.place.block] = 0x1100;
  const AddressMap map(layout, addresses);
  EXPECT_GE(map.end_of(0x1000), 0x1100u);
  EXPECT_GE(map.end_of(0x1100), 0x1300u);
  EXPECT_GE(map.end_of(0x11fc), 0x1300u);
}

TEST_F(HazardsTest, MoreThanFitAreKeptApart) {
  for (int i = 0; i < 200; ++i) chain.run(stages::copy_words, {chain.at(a), {}, 0, 0}, {1, 1, 1});
  const std::string found = barriers();
  EXPECT_EQ(std::ranges::count(found, '|'), 2);
  EXPECT_EQ(found[128], '|');
}

// --- Whole chains.

struct ChainCase {
  const char* name;
  DeviceBuilder builder;
  bool lookback = true;
  Walk walk = Walk::binary;
};

std::ostream& operator<<(std::ostream& out, const ChainCase& one) { return out << one.name; }

constexpr ChainCase chain_cases[] = {{"ploc", DeviceBuilder::ploc, true, Walk::binary},
                                     {"ploc_without_lookback", DeviceBuilder::ploc, false, Walk::brute_force},
                                     {"hploc_wide_packets", DeviceBuilder::hploc, true, Walk::wide_packets},
                                     {"hploc_wide_single", DeviceBuilder::hploc, false, Walk::wide_single},
                                     {"lbvh", DeviceBuilder::lbvh, true, Walk::binary}};

// Memory after a chain, whose steps that may overlap are run in order or the other way round. For the stage
// of its name `declared` is taken.
struct OverlapRun {
  bool reversed = false;
  const StageDeclaration* declared = nullptr;
  std::size_t left_out = 0;  // barriers

  std::vector<std::byte> memory_after(CpuExecutor& executor, const Layout& layout, std::vector<Step> steps) {
    Hazards hazards(AddressMap(layout, executor.block_addresses()));
    std::vector<std::vector<Step>> groups;
    for (Step& step : steps) {
      const StageDeclaration* const stage = stage_of(step);
      if (stage && declared && std::string_view(stage->name) == declared->name)
        dispatch_of(step)->stage = declared;
      if (hazards.needs_barrier(step) || groups.empty()) groups.emplace_back();
      groups.back().push_back(step);
    }
    for (std::vector<Step>& group : groups) {
      if (reversed) std::ranges::reverse(group);
      executor.run(group);
    }
    left_out = steps.size() - groups.size();
    std::vector<std::byte> bytes;
    for (std::uint32_t block = 0; block < layout.block_bytes().size(); ++block) {
      const std::byte* const first = executor.at({block, 0});
      bytes.insert(bytes.end(), first, first + layout.block_bytes()[block]);
    }
    return bytes;
  }
};

// A frame of 3,000 triangles with two samples a pixel.
class FrameHazards : public testing::TestWithParam<ChainCase> {
 protected:
  static FramePlan plan(Layout& layout, const SceneArrays& arrays) {
    BuildOptions build;
    build.builder = GetParam().builder;
    build.lookback = GetParam().lookback;
    TraceOptions trace;
    trace.width = 31;
    trace.height = 23;
    trace.samples = 2;
    trace.walk = GetParam().walk;
    return plan_frame(layout, arrays, {build, 0, trace});
  }

  const Scene scene = find_hard_case("nested")->make(3000, 1);
  const SceneArrays arrays = scene_arrays(scene);
  Layout layout;
  const FramePlan frame = plan(layout, arrays);

  std::vector<std::byte> memory_after(OverlapRun run) const {
    CpuExecutor executor(layout);
    upload_frame(executor, frame.tree, frame.trace, arrays, make_film(scene, {}, 31, 23, 2));
    Chain chain = executor.chain();
    append_frame(chain, frame);
    return run.memory_after(executor, layout, chain.steps());
  }
};

TEST_P(FrameHazards, StepsThatMayOverlapMayBeRunInAnyOrder) {
  EXPECT_TRUE(memory_after({.reversed = false}) == memory_after({.reversed = true}));
}

// A stage of which is said that it only reads: rays are traced before they are made.
TEST_P(FrameHazards, AFalseDeclarationIsSeen) {
  StageDeclaration faulty = stages::camera_rays;
  std::vector<AddressArg> addresses(faulty.addresses.begin(), faulty.addresses.end());
  for (AddressArg& address : addresses) address.written = false;
  faulty.addresses = addresses;
  EXPECT_FALSE(memory_after({.reversed = false}) == memory_after({.reversed = true, .declared = &faulty}));
}

INSTANTIATE_TEST_SUITE_P(Chains, FrameHazards, testing::ValuesIn(chain_cases),
                         [](const auto& info) { return std::string(info.param.name); });

// All that the library does, as the self-check runs it.
TEST(LibraryHazards, StepsThatMayOverlapMayBeRunInAnyOrder) {
  DeviceProperties device{};
  device.max_block_bytes = std::uint64_t{1} << 30;
  for (const bool lookback : {true, false}) {
    for (const Walk walk : {Walk::binary, Walk::wide_single}) {
      DeviceUse use{.traces = {TraceOptions{.walk = walk}}};
      use.wide = use.inputs = use.batches = use.sorts = use.sorts_values = use.scans = use.every_ray = true;
      use.build.variants.sort = SORT_ONESWEEP_RUNS;
      const CheckChain check = check_chain_of(device, use, lookback);
      std::vector<std::byte> memory[2];
      for (const bool reversed : {false, true}) {
        CpuExecutor executor(check.layout());
        check.upload_to(executor);
        Chain chain = executor.chain();
        check.append_to(chain);
        OverlapRun run{.reversed = reversed};
        memory[reversed] = run.memory_after(executor, check.layout(), chain.steps());
        EXPECT_GT(run.left_out, 10u);
      }
      EXPECT_TRUE(memory[0] == memory[1]) << "lookback " << lookback << ", " << name_of(walk);
    }
  }
}

}  // namespace
}  // namespace coppice
