// The prefix scan gives what std::exclusive_scan gives, in every size, in lockstep with its twins, and
// whatever tiles report; and where too many do not, an error by name.
#include <gtest/gtest.h>

#include <numeric>

#include "pipeline/scan_plan.h"
#include "scene/random.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/planted_faults.h"
#include "support/test_device.h"

namespace coppice {
namespace {

constexpr std::uint32_t tile_words = SCAN_TILE * 4;

std::vector<uint> random_words(std::size_t count, uint mask = ~0u) {
  Random random(static_cast<std::uint32_t>(count) + 1);
  std::vector<uint> words(count);
  for (uint& word : words) word = random.next() & mask;
  return words;
}

std::vector<uint> scanned(std::vector<uint> words) {
  std::exclusive_scan(words.begin(), words.end(), words.begin(), 0u);
  return words;
}

class DeviceScan : public DeviceTest {
 protected:
  static void expect_in_lockstep(const std::vector<uint>& words, const BuildOptions& options) {
    Layout layout(test_device().properties().max_block_bytes);
    const ScanPlan plan = plan_scan(layout, words.size(), options);
    LockstepExecutor executor(test_device(), layout);
    executor.upload(ScanPlan::words_of(plan.source), std::span<const uint>(words));
    const auto difference = executor.run([&](Chain& chain) { append_scan(chain, plan); });
    EXPECT_FALSE(difference) << words.size() << " words: " << difference->stage << " " << difference->slot
                             << "[" << difference->index << "]";
    EXPECT_EQ(executor.gpu().read(Slot<uint>{plan.target.place, words.size()}), scanned(words))
        << words.size() << " words";
  }

  // The error, or none if the sums are right.
  static std::string error_of(std::uint32_t tiles, const BuildOptions& options) {
    const std::vector<uint> words = random_words(std::size_t{tiles} * tile_words - 5);
    Layout layout(test_device().properties().max_block_bytes);
    const ScanPlan plan = plan_scan(layout, words.size(), options);
    GpuExecutor executor(test_device(), layout);
    executor.upload(ScanPlan::words_of(plan.source), std::span<const uint>(words));
    Chain chain = executor.chain();
    append_scan(chain, plan);
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    const std::string error = describe_error_word(executor.read(plan.state)[0].error_word);
    if (!error.empty()) return error;
    const bool right = executor.read(Slot<uint>{plan.target.place, words.size()}) == scanned(words);
    return right ? "" : "wrong sums";
  }
};

TEST_F(DeviceScan, EverySizeUpToThreeHundred) {
  for (std::uint32_t size = 0; size <= 300; ++size) expect_in_lockstep(random_words(size), {});
}

TEST_F(DeviceScan, SizesAboutRunsAndTiles) {
  for (const bool lookback : {true, false}) {
    BuildOptions options;
    options.lookback = lookback;
    for (const std::uint32_t size : {1u, SCAN_RUN * 4 - 1, SCAN_RUN * 4 + 1, tile_words - 1, tile_words,
                                     tile_words + 1, 2 * tile_words, 5 * tile_words + 3, 20 * tile_words - 4})
      expect_in_lockstep(random_words(size), options);
  }
}

// Every tile's sum of lower halves is as large as it can be, and every carry there is, is taken.
TEST_F(DeviceScan, LargestAndSmallestWords) {
  for (const uint word : {0u, 1u, 0xffffu, 0x10000u, 0x80000000u, 0xffffffffu})
    expect_in_lockstep(std::vector<uint>(3 * tile_words + 1, word), {});
}

TEST_F(DeviceScan, TilesOutOfOrderLateOrSilent) {
  for (const std::uint32_t bits :
       {LOOKBACK_REVERSED, LOOKBACK_WITHHELD, LOOKBACK_REVERSED | LOOKBACK_WITHHELD | silent(8)}) {
    BuildOptions options;
    options.lookback_stress = bits;
    for (const std::uint32_t tiles : {1u, 2u, 3u, 63u, 66u, 300u})
      EXPECT_EQ(error_of(tiles, options), "") << tiles << " tiles";
    options.lookback_max_fallbacks = 0;
    const std::string error = error_of(20, options);
    if (bits & LOOKBACK_WITHHELD) {
      EXPECT_NE(error.find("prefix_scan: a tile waited in vain"), std::string::npos) << "'" << error << "'";
    }
  }
}

TEST_F(DeviceScan, TooManySilentTilesAreAnErrorByName) {
  constexpr std::uint32_t late_tiles = 8;  // a tile that is merely late costs a fallback too
  BuildOptions options;
  options.lookback_stress = silent(options.lookback_max_fallbacks - late_tiles);
  EXPECT_EQ(error_of(70, options), "");
  options.lookback_stress = silent(options.lookback_max_fallbacks + 1);
  EXPECT_NE(error_of(70, options).find("prefix_scan: a tile waited in vain"), std::string::npos);
}

TEST_F(DeviceScan, RefusesMoreWordsThanFit) {
  Layout layout(std::uint64_t{1} << 40);
  EXPECT_NO_THROW(plan_scan(layout, max_scan_words, {}));
  EXPECT_THROW(plan_scan(layout, max_scan_words + 1, {}), std::invalid_argument);
}

TEST_F(DeviceScan, NamesAPlantedFaultByStageAndSlot) {
  const struct {
    StageDeclaration declaration;
    const char* slot;
    bool lookback;
  } faults[] = {
      {faulty<&stages::prefix_scan,
              [](const void* args) {
                const auto& scan = *static_cast<const PrefixScanArgs*>(args);
                ++scan.target[(scan.word_count + 3) / 4].x;  // one past the end
              }>(),
       "scan_target", true},
      {faulty<&stages::scan_tile_sums,
              [](const void* args) { ++static_cast<const ScanTileSumsArgs*>(args)->tile_sums[1]; }>(),
       "scan_status", false}};
  for (const auto& fault : faults) {
    Layout layout(test_device().properties().max_block_bytes);
    BuildOptions options;
    options.lookback = fault.lookback;
    const ScanPlan plan = plan_scan(layout, 2 * tile_words, options);
    LockstepExecutor executor(test_device(), layout);
    const auto difference = executor.run([&](Chain& chain) {
      append_scan(chain, plan);
      for (Step& step : chain.steps()) {
        if (stage_of(step) && std::string_view(stage_of(step)->name) == fault.declaration.name)
          dispatch_of(step)->stage = &fault.declaration;
      }
    });
    ASSERT_TRUE(difference) << fault.declaration.name;
    EXPECT_STREQ(difference->stage.c_str(), fault.declaration.name);
    EXPECT_EQ(difference->slot, fault.slot);
  }
}

}  // namespace
}  // namespace coppice
