// Lookback gives the same sums whatever order tiles run in and whichever of them report; and where too many
// do not, an error by name.
#include <gtest/gtest.h>

#include <thread>

#include "analysis/tree_hash.h"
#include "builders/ploc.h"
#include "interface/sort.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"
#include "support/device_run.h"
#include "support/planted_faults.h"

namespace coppice {
namespace {

struct Stress {
  const char* name;
  std::uint32_t bits;
};

constexpr Stress stresses[] = {
    {"reversed", LOOKBACK_REVERSED},
    {"withheld", LOOKBACK_WITHHELD},
    {"reversed, withheld, 8 silent", LOOKBACK_REVERSED | LOOKBACK_WITHHELD | silent(8)}};

BuildOptions stressed(std::uint32_t bits) {
  BuildOptions options;
  options.radius = 2;
  options.lookback_stress = bits;
  return options;
}

// Triangles for so many tiles of a kernel, the last one not full.
std::vector<Triangle> triangles_of(std::uint32_t tiles, std::uint32_t tile_size) {
  return random_triangles(tiles * tile_size - tile_size / 3, tiles);
}

class DeviceLookback : public DeviceTest {
 protected:
  static void expect_right_trees(std::uint32_t tiles, std::uint32_t tile_size) {
    const std::vector<Triangle> triangles = triangles_of(tiles, tile_size);
    const std::uint64_t expected = tree_hash(build_ploc(triangles, {2, 30}).nodes);
    for (const Stress& stress : stresses) {
      EXPECT_EQ(tree_hash(build_on(test_device(), triangles, stressed(stress.bits)).nodes), expected)
          << stress.name << ", " << tiles << " tiles of " << tile_size;
    }
  }

  // The state after one build, whether it succeeds or not.
  static BuildState state_after(std::span<const Triangle> triangles, const BuildOptions& options) {
    Layout layout(test_device().properties().max_block_bytes);
    const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()), options);
    GpuExecutor executor(test_device(), layout);
    executor.upload(plan.triangles, triangles);
    Chain chain = executor.chain();
    append_build(chain, plan);
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    return executor.read(plan.state)[0];
  }

  static void expect_error(std::span<const Triangle> triangles, const BuildOptions& options,
                           const std::string& stage) {
    const BuildState state = state_after(triangles, options);
    const std::string error = describe_error_word(state.error_word);
    EXPECT_NE(error.find(stage + ": a tile waited in vain"), std::string::npos) << "'" << error << "'";
    EXPECT_EQ(state.active_count, 0u) << "a trace would walk what is no tree";
  }

  // To sum up 64 tiles of a sort takes more loop turns than old lavapipe grants.
  static bool loops_end_by_themselves() { return test_device().properties().loop_turn_limit != 0; }
};

TEST_F(DeviceLookback, OneToThreeTilesOfAMerge) {
  for (const std::uint32_t tiles : {1u, 2u, 3u}) expect_right_trees(tiles, PLOC_MERGE_TILE);
}

TEST_F(DeviceLookback, AboutSixtyFourTilesOfAMerge) {
  for (std::uint32_t tiles = 63; tiles <= 66; ++tiles) expect_right_trees(tiles, PLOC_MERGE_TILE);
}

TEST_F(DeviceLookback, ThreeHundredTilesOfAMerge) { expect_right_trees(300, PLOC_MERGE_TILE); }

TEST_F(DeviceLookback, OneToThreeTilesOfASort) {
  for (const std::uint32_t tiles : {1u, 2u, 3u}) expect_right_trees(tiles, SORT_RUNS_TILE);
}

TEST_F(DeviceLookback, AboutSixtyFourTilesOfASort) {
  for (const std::uint32_t tiles : {64u, 66u}) expect_right_trees(tiles, SORT_RUNS_TILE);
}

// Where all words end as they do in an undisturbed run, they and everything else equal the twins' bits.
TEST_F(DeviceLookback, ReversedTilesLeaveTheSameBitsAsTheTwins) {
  const std::vector<Triangle> triangles = triangles_of(20, SORT_RUNS_TILE);
  Layout layout(test_device().properties().max_block_bytes);
  const BuildPlan plan =
      plan_build(layout, static_cast<std::uint32_t>(triangles.size()), stressed(LOOKBACK_REVERSED));
  LockstepExecutor executor(test_device(), layout);
  executor.upload(plan.triangles, std::span<const Triangle>(triangles));
  const auto difference = executor.run([&](Chain& chain) { append_build(chain, plan); });
  EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index << "]";
}

// --- That the tests above had to fall back: with the same stress and no fallbacks allowed, no build
// succeeds.

TEST_F(DeviceLookback, WithheldWordsCannotBeHadWithoutFallback) {
  const std::vector<Triangle> triangles = triangles_of(20, SORT_RUNS_TILE);
  for (const std::uint32_t bits : {LOOKBACK_WITHHELD, silent(1)}) {
    BuildOptions options = stressed(bits);
    options.lookback_max_fallbacks = 0;
    expect_error(triangles, options, "sort_pass");
  }
}

TEST_F(DeviceLookback, ReversedTilesCannotDoWithoutFallbackOnFewThreads) {
  // Each of lavapipe's threads runs a workgroup to its end, so of LOOKBACK_REVERSED_TILES not all can run at
  // once.
  if (test_device().properties().type != DeviceType::cpu ||
      std::thread::hardware_concurrency() >= LOOKBACK_REVERSED_TILES) {
    GTEST_SKIP() << "this device may run all tiles at once";
  }
  BuildOptions options = stressed(LOOKBACK_REVERSED);
  options.lookback_max_fallbacks = 0;
  expect_error(triangles_of(20, SORT_RUNS_TILE), options, "sort_pass");
}

// --- Too many tiles that do not report.

// A tile that is merely late, because its thread was interrupted, costs a fallback too.
constexpr std::uint32_t late_tiles = 8;

// For an error every tile is silent: tiles that are not share their fallbacks, so that by two threads abreast
// none may need too many.
constexpr std::uint32_t every_tile = (1u << (32 - LOOKBACK_SILENT_SHIFT)) - 1;

TEST_F(DeviceLookback, AlmostAsManySilentTilesOfAMergeAsFallbacksAreStillRight) {
  const std::vector<Triangle> triangles = triangles_of(70, PLOC_MERGE_TILE);
  const BuildOptions options = stressed(silent(64 - late_tiles));
  ASSERT_EQ(options.lookback_max_fallbacks, 64u);
  EXPECT_EQ(tree_hash(build_on(test_device(), triangles, options).nodes),
            tree_hash(build_ploc(triangles, {2, 30}).nodes));
}

TEST_F(DeviceLookback, MoreSilentTilesOfAMergeThanFallbacksAreAnErrorByName) {
  const std::vector<Triangle> triangles = triangles_of(70, PLOC_MERGE_TILE);
  expect_error(triangles, stressed(silent(every_tile)), "ploc_merge");
  EXPECT_EQ(state_after(triangles, stressed(silent(every_tile))).error_word & ERROR_SORT_LOOKBACK, 0u);
}

TEST_F(DeviceLookback, AlmostAsManySilentTilesOfASortAsFallbacksAreStillRightAndMoreAreAnErrorByName) {
  const std::uint32_t most = loops_end_by_themselves() ? 16 : 64;
  const std::vector<Triangle> triangles = triangles_of(most + 5, SORT_RUNS_TILE);
  BuildOptions options = stressed(silent(most - late_tiles));
  options.lookback_max_fallbacks = most;
  EXPECT_EQ(tree_hash(build_on(test_device(), triangles, options).nodes),
            tree_hash(build_ploc(triangles, {2, 30}).nodes));
  options.lookback_stress = silent(every_tile);
  expect_error(triangles, options, "sort_pass");
}

}  // namespace
}  // namespace coppice
