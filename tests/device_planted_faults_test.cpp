// Whatever stage goes wrong, lockstep finds it there: each stage of the table gets a fault, on a device that
// is compared bit for bit and on one that is taken for a GPU. A stage in none of the chains of
// support/stage_chains.cpp fails the test.
#include <algorithm>
#include <set>

#include "stages/stages.h"
#include "support/stage_chains.h"

namespace coppice {
namespace {

// --- A twin that does its work and then spoils what it wrote. A twin is a plain function, so what it is
// about is global.

struct Word {
  std::string slot;
  std::uint64_t index;  // of the element
};

using Damage = void (*)(std::span<std::uint32_t> words, const std::vector<bool>& changed);

struct Planting {
  const StageDeclaration* stage = nullptr;
  const LockstepExecutor* executor = nullptr;
  std::string_view only;  // slot; empty: the first that the stage changes
  Damage damage = nullptr;
  std::optional<Word> where;
} planting;

// The slot with all that lies behind it, up to where nothing is promised any more.
std::span<std::uint32_t> words_of(const SlotListing& slot) {
  auto* const first = reinterpret_cast<std::uint32_t*>(planting.executor->cpu().at(slot.place));
  return {first, (slot.bytes() + Layout::guard_bytes) / 4};
}

void run_and_spoil(const void* args) {
  const std::vector<SlotListing>& slots = planting.executor->layout().slots();
  std::vector<std::vector<std::uint32_t>> before;
  for (const SlotListing& slot : slots) before.emplace_back(words_of(slot).begin(), words_of(slot).end());
  planting.stage->twin(args);
  for (std::size_t i = 0; i < slots.size() && !planting.where; ++i) {
    const std::span<std::uint32_t> words = words_of(slots[i]);
    std::vector<bool> changed(words.size());
    for (std::size_t k = 0; k < words.size(); ++k) changed[k] = words[k] != before[i][k];
    const auto first = std::ranges::find(changed, true) - changed.begin();
    if (first == std::ssize(changed) || !(planting.only.empty() || slots[i].name == planting.only)) continue;
    planting.where = Word{slots[i].name, first * 4 / slots[i].element_bytes};
    planting.damage(words, changed);
  }
}

Found run_with_fault(Device& device, std::size_t chain, const StageDeclaration& stage, Damage damage,
                     std::string_view slot = {}) {
  static StageDeclaration faulty;
  faulty = stage;
  faulty.twin = run_and_spoil;
  return run_stage_chain(device, chain, [&](std::vector<Step>& steps, const LockstepExecutor& executor) {
    planting = {&stage, &executor, slot, damage, {}};
    for (Step& step : steps) {
      if (stage_of(step) == &stage) dispatch_of(step)->stage = &faulty;
    }
  });
}

// Which chain has the stage first.
std::vector<std::set<const StageDeclaration*>> stages_of_chains(Device& device) {
  std::vector<std::set<const StageDeclaration*>> stages(stage_chain_count);
  for (std::size_t chain = 0; chain < stage_chain_count; ++chain) {
    run_stage_chain(device, chain, [&](std::vector<Step>& steps, const LockstepExecutor&) {
      for (const Step& step : steps) stages[chain].insert(stage_of(step));
      steps.clear();
    });
  }
  return stages;
}

void one_bit(std::span<std::uint32_t> words, const std::vector<bool>& changed) {
  words[std::ranges::find(changed, true) - changed.begin()] ^= 1;
}

void all_that_changed(std::span<std::uint32_t> words, const std::vector<bool>& changed) {
  for (std::size_t i = 0; i < words.size(); ++i) words[i] ^= changed[i] ? 0x40000004u : 0;
}

void one_past_the_end(std::span<std::uint32_t> words, const std::vector<bool>&) {
  words[words.size() - Layout::guard_bytes / 4] ^= 1;
}

void last_of_the_guard(std::span<std::uint32_t> words, const std::vector<bool>&) { words.back() ^= 1; }

class PlantedFaults : public DeviceTest {
 protected:
  static Device& like_a_gpu() {
    static Device device({"", false, true});
    return device;
  }

  // In every stage, by the damage: named by stage, slot and, where one word is spoilt, by index.
  static void expect_found(Device& device, Damage (*damage_for)(const StageDeclaration&)) {
    const auto stages = stages_of_chains(device);
    for (const StageDeclaration* const stage : all_stages()) {
      const auto chain = std::ranges::find_if(stages, [&](const auto& its) { return its.contains(stage); });
      ASSERT_NE(chain, stages.end()) << stage->name << " is in no chain of this test: add it to one";
      const Damage damage = damage_for(*stage);
      const Found found = run_with_fault(device, chain - stages.begin(), *stage, damage);
      ASSERT_TRUE(planting.where) << stage->name << " changed nothing";
      ASSERT_TRUE(found.difference) << stage->name << ": not noticed in " << planting.where->slot;
      EXPECT_EQ(found.difference->stage, stage->name);
      EXPECT_EQ(found.difference->slot, planting.where->slot) << stage->name;
      if (damage == one_bit) {
        EXPECT_EQ(found.difference->index, planting.where->index) << stage->name;
      }
    }
  }
};

TEST_F(PlantedFaults, OneWrongBitOfAnyStageIsFound) {
  if (!rounds_like_the_host(test_device().properties())) GTEST_SKIP() << "not compared bit for bit";
  expect_found(test_device(), [](const StageDeclaration&) -> Damage { return one_bit; });
}

// LikeAGpu is in the names of what runs on the reference driver only.
using PlantedFaultsLikeAGpu = PlantedFaults;

TEST_F(PlantedFaultsLikeAGpu, AnyStageWithoutAToleranceIsHeldToEveryBitAndTheOthersToTheirs) {
  expect_found(like_a_gpu(), [](const StageDeclaration& stage) -> Damage {
    return stage.nearly.empty() ? one_bit : all_that_changed;
  });
}

// What else a stage with a tolerance may do wrong.
TEST_F(PlantedFaultsLikeAGpu, NoToleranceReachesBeyondItsSlot) {
  const auto stages = stages_of_chains(like_a_gpu());
  for (const StageDeclaration* const stage : all_stages()) {
    for (const NearlySlot& nearly : stage->nearly) {
      for (const Damage damage : {one_past_the_end, last_of_the_guard}) {
        Found found;
        planting = {};
        // In the first chain in which the stage writes to the slot.
        for (std::size_t chain = 0; chain < stages.size() && !planting.where; ++chain) {
          if (stages[chain].contains(stage))
            found = run_with_fault(like_a_gpu(), chain, *stage, damage, nearly.slot);
        }
        ASSERT_TRUE(planting.where && found.difference) << stage->name << ", " << nearly.slot;
        EXPECT_EQ(found.difference->stage, stage->name);
        EXPECT_EQ(found.difference->slot, nearly.slot) << "in " << stage->name;
      }
    }
  }
}

// One ray of 7 goes through what it should hit; all hit another triangle, or farther away; all are some
// roundings off.
TEST_F(PlantedFaultsLikeAGpu, HitsAreComparedAsHits) {
  const Damage lost = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < chain_width * chain_height; hit += 7) {
      if (changed[4 * hit + 1]) words[4 * hit] = 0x7f800000, words[4 * hit + 1] = NO_TRIANGLE;
    }
  };
  const Damage other = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < chain_width * chain_height; ++hit)
      words[4 * hit + 1] ^= changed[4 * hit + 1];
  };
  const Damage farther = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < chain_width * chain_height; ++hit)
      words[4 * hit] += changed[4 * hit + 1] ? 1024 : 0;
  };
  const Damage roundings = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < chain_width * chain_height; ++hit)
      words[4 * hit] += changed[4 * hit + 1] ? 3 : 0;
  };
  const StageDeclaration* const tracers[] = {&stages::trace_closest, &stages::trace_wide,
                                             &stages::trace_wide_single};
  for (std::size_t chain = 0; chain < std::size(tracers); ++chain) {
    for (const Damage damage : {lost, other, farther}) {
      const Found found = run_with_fault(like_a_gpu(), chain, *tracers[chain], damage, "hits");
      ASSERT_TRUE(found.difference) << tracers[chain]->name
                                    << (damage == lost    ? ", lost"
                                        : damage == other ? ", other"
                                                          : ", farther");
      EXPECT_EQ(found.difference->stage, tracers[chain]->name);
      EXPECT_EQ(found.difference->slot, "hits");
      EXPECT_NE(found.difference->why, "");
    }
    const Found found = run_with_fault(like_a_gpu(), chain, *tracers[chain], roundings, "hits");
    EXPECT_FALSE(found.difference) << found.difference->stage << ", " << found.difference->slot << ": "
                                   << found.difference->why;
    const auto hits = std::ranges::find_if(
        found.nearly, [](const NearlyListing& one) { return one.slot == std::string_view("hits"); });
    ASSERT_NE(hits, found.nearly.end());
    EXPECT_GT(hits->sum.differing, 50u);
    EXPECT_EQ(hits->sum.beyond, 0u);
  }
}

// Memory that no slot holds, and steps that are no stage.
TEST_F(PlantedFaults, AlsoBetweenSlotsAndAfterClears) {
  Layout layout(test_device().properties().max_block_bytes);
  const auto first = layout.add<uint>("first", 3), second = layout.add<uint>("second", 5);
  for (const std::uint64_t byte :
       {12u, 255u, 256u, 511u}) {  // the gap that aligns the next slot, and the guard
    LockstepExecutor executor(test_device(), layout);
    *(executor.cpu().at(first.place) + byte) = std::byte{1};
    const auto difference = executor.run([&](Chain& chain) { chain.clear(second); });
    ASSERT_TRUE(difference) << byte;
    EXPECT_EQ(difference->slot, "first");
    EXPECT_EQ(difference->index, byte / 4);
  }
  LockstepExecutor executor(test_device(), layout);
  executor.upload(second, std::span<const uint>(std::vector<uint>{1, 2, 3, 4, 5}));
  bool on_device = true;
  const auto difference = executor.run([&](Chain& chain) {
    chain.clear(second);
    if (!std::exchange(on_device, false))
      std::get<Clear>(chain.steps()[0]).place.offset += 4;  // the host leaves the first word
  });
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->stage, "clear");
  EXPECT_EQ(difference->slot, "second");
  EXPECT_EQ(difference->index, 0u);
}

}  // namespace
}  // namespace coppice
