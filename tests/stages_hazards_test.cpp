// Which steps may overlap: what depends on each other stays apart, and what does not may be run in any order.
#include <gtest/gtest.h>

#include <algorithm>

#include "measure/copy_limit.h"
#include "pipeline/batch.h"
#include "pipeline/scan_plan.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/cpu_executor.h"
#include "stages/hazards.h"
#include "stages/stages.h"
#include "support/triangles.h"

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

TEST_F(HazardsTest, MoreThanFitAreKeptApart) {
  for (int i = 0; i < 200; ++i) chain.run(stages::copy_words, {chain.at(a), {}, 0, 0}, {1, 1, 1});
  const std::string found = barriers();
  EXPECT_EQ(std::ranges::count(found, '|'), 2);
  EXPECT_EQ(found[128], '|');
}

// --- Whole chains.

struct ChainCase {
  const char* name;
  std::optional<DeviceBuilder> builder{};
  bool lookback = true;
  Walk walk = Walk::binary;
};

std::ostream& operator<<(std::ostream& out, const ChainCase& one) { return out << one.name; }

constexpr ChainCase chain_cases[] = {{"ploc", DeviceBuilder::ploc, true, Walk::binary},
                                     {"ploc_without_lookback", DeviceBuilder::ploc, false, Walk::brute_force},
                                     {"hploc_wide_packets", DeviceBuilder::hploc, true, Walk::wide_packets},
                                     {"hploc_wide_single", DeviceBuilder::hploc, false, Walk::wide_single},
                                     {"lbvh", DeviceBuilder::lbvh, true, Walk::binary}};

// A frame of 3,000 triangles with two samples a pixel.
class FrameHazards : public testing::TestWithParam<ChainCase> {
 protected:
  static SceneArrays frame_arrays() {
    SceneArrays arrays = scene_arrays(find_hard_case("nested")->make(3000, 1));
    arrays.lighting = {};
    return arrays;
  }

  static FramePlan plan(Layout& layout, const SceneArrays& arrays) {
    BuildOptions build;
    build.builder = *GetParam().builder;
    build.lookback = GetParam().lookback;
    TraceOptions trace;
    trace.width = 31;
    trace.height = 23;
    trace.samples = 2;
    trace.walk = GetParam().walk;
    return plan_frame(layout, arrays, {build, 0, trace});
  }

  const SceneArrays arrays = frame_arrays();
  Layout layout;
  const FramePlan frame = plan(layout, arrays);

  void upload(CpuExecutor& executor) const {
    const Scene scene = find_hard_case("nested")->make(3000, 1);
    upload_frame(executor, frame.tree, frame.trace, arrays, make_film(scene, {}, 31, 23, 2));
  }

  std::vector<std::byte> memory(const CpuExecutor& executor) const {
    std::vector<std::byte> bytes;
    for (std::uint32_t block = 0; block < layout.block_bytes().size(); ++block) {
      const std::byte* const first = executor.at({block, 0});
      bytes.insert(bytes.end(), first, first + layout.block_bytes()[block]);
    }
    return bytes;
  }

  // Memory after the frame: steps that may overlap in the order of the chain or the other way round. For the
  // stage of its name `declared` is taken.
  std::vector<std::byte> memory_after(bool reversed, const StageDeclaration* declared = nullptr,
                                      std::size_t* barriers_left_out = nullptr) const {
    CpuExecutor executor(layout);
    upload(executor);
    Chain chain = executor.chain();
    append_frame(chain, frame);
    Hazards hazards(AddressMap(layout, executor.block_addresses()));
    std::vector<std::vector<Step>> groups;
    for (Step& step : chain.steps()) {
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
    if (barriers_left_out) *barriers_left_out = chain.steps().size() - groups.size();
    return memory(executor);
  }
};

TEST_P(FrameHazards, StepsThatMayOverlapMayBeRunInAnyOrder) {
  std::size_t left_out = 0;
  EXPECT_EQ(memory_after(false), memory_after(true, nullptr, &left_out));
  EXPECT_GT(left_out, 0u);
}

// A stage of which is said that it only reads: the picture is resolved before it is shaded.
TEST_P(FrameHazards, AFalseDeclarationIsSeen) {
  StageDeclaration faulty = stages::shade;
  std::vector<AddressArg> addresses(faulty.addresses.begin(), faulty.addresses.end());
  for (AddressArg& address : addresses) address.written = false;
  faulty.addresses = addresses;
  EXPECT_NE(memory_after(false), memory_after(true, &faulty));
}

INSTANTIATE_TEST_SUITE_P(Chains, FrameHazards, testing::ValuesIn(chain_cases),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace coppice
