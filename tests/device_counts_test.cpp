// Counts that only the device knows: what is sorted, scanned and built is what as many would give, in
// lockstep with the twins; what lies behind is not touched; and more than was planned for is an error by
// name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>

#include "analysis/tree_hash.h"
#include "interface/sort.h"
#include "pipeline/scan_plan.h"
#include "pipeline/wide_plan.h"
#include "scene/random.h"
#include "stages/errors.h"
#include "support/counted_run.h"
#include "support/device_run.h"

namespace coppice {
namespace {

std::vector<uint> many_words(std::size_t count) {
  Random random(static_cast<std::uint32_t>(count) + 7);
  std::vector<uint> words(count);
  for (uint& word : words) word = random.next();
  return words;
}

class DeviceCounts : public DeviceTest {
 protected:
  static void expect_state(const BuildState& state, uint asked, std::uint32_t most) {
    EXPECT_EQ(state.primitive_count, asked);
    EXPECT_EQ(state.error_word, asked > most ? ERROR_COUNT : 0u);
    if (asked > most) {
      EXPECT_NE(describe_error_word(state.error_word).find("the count on the device"), std::string::npos);
    }
  }
};

// --- The sort.

struct CountedSort {
  std::uint32_t variant, key_words;
};

class DeviceCountsSort : public DeviceCounts, public testing::WithParamInterface<CountedSort> {
 protected:
  static void expect_sorted(std::uint32_t most, uint asked) {
    SCOPED_TRACE(std::to_string(asked) + " of " + std::to_string(most));
    const std::uint32_t words = GetParam().key_words, count = std::min(asked, most);
    BuildOptions options;
    options.morton_bits = 30 * words;
    options.variants.sort = GetParam().variant;
    CountedRun run;
    const BuildPlan plan = plan_sort(run.layout, most, options);
    run.start(asked);
    const std::vector<uint> keys = many_words(std::size_t{most} * words);
    std::vector<uint> values(most);
    std::iota(values.begin(), values.end(), 0u);
    for (int i = 0; i < 2; ++i) run.fill(plan.keys[i]), run.fill(plan.values[i]);
    run.executor->upload(plan.unsorted_keys, std::span<const uint>(keys));
    run.executor->upload(plan.unsorted_values, std::span<const uint>(values));
    run.expect_same_bits([&](Chain& chain) { append_sort(chain, plan, chain.at(run.count)); });
    if (HasFatalFailure()) return;

    const auto key_of = [&](uint i) {
      return words == 1 ? keys[i] : std::uint64_t{keys[2 * i + 1]} << 32 | keys[2 * i];
    };
    std::ranges::stable_sort(std::span(values).first(count), {}, key_of);
    const std::vector<uint> sorted = run.read(plan.values[0]);
    EXPECT_TRUE(std::equal(values.begin(), values.begin() + count, sorted.begin()));
    const std::vector<uint> sorted_keys = run.read(plan.keys[0]);
    for (uint i = 0; i < count * words; ++i)
      ASSERT_EQ(sorted_keys[i], keys[values[i / words] * words + i % words]) << i;
    // Behind the count everything is as it was: the input where the sort begins, and the sentinel.
    const bool ends_elsewhere = plan.sort.passes % 2 == 1;
    for (uint i = count; i < most; ++i) {
      ASSERT_EQ(sorted[i], ends_elsewhere ? SENTINEL : values[i]) << i;
      ASSERT_EQ(sorted_keys[i * words], ends_elsewhere ? SENTINEL : keys[i * words]) << i;
    }
    expect_state(run.read(plan.state)[0], asked, most);
  }

  static std::uint32_t tile_keys() {
    BuildOptions options;
    options.variants.sort = GetParam().variant;
    Layout layout;
    return plan_sort(layout, 1, options).sort.tile_keys;
  }
};

TEST_P(DeviceCountsSort, WithinOneTile) {
  for (const uint asked : {0u, 1u, 2u, 63u, 64u, 299u, 300u, 301u, ~0u}) expect_sorted(300, asked);
}

TEST_P(DeviceCountsSort, NoneAtAll) {
  for (const uint asked : {0u, 1u}) expect_sorted(0, asked);
}

TEST_P(DeviceCountsSort, AboutTheEndsOfTiles) {
  const std::uint32_t tile = tile_keys(), most = 3 * tile + tile / 3;
  for (const uint asked : {0u, 1u, tile - 1, tile, tile + 1, 2 * tile, 3 * tile + 5, most, most + 1})
    expect_sorted(most, asked);
}

std::vector<CountedSort> counted_sorts() {
  std::vector<CountedSort> cases;
  const auto variants = static_cast<std::uint32_t>(variant_stages()[0].values.size());
  for (std::uint32_t variant = 0; variant < variants; ++variant) {
    for (const std::uint32_t key_words : {1u, 2u}) cases.push_back({variant, key_words});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Variants, DeviceCountsSort, testing::ValuesIn(counted_sorts()),
                         [](const auto& info) {
                           std::string name(variant_stages()[0].values[info.param.variant]);
                           std::ranges::replace(name, '-', '_');
                           return name + (info.param.key_words == 1 ? "_32" : "_64");
                         });

// --- The scan.

class DeviceCountsScan : public DeviceCounts, public testing::WithParamInterface<bool> {
 protected:
  // Without a count on the device where none is asked for.
  static void expect_scanned(std::uint32_t most, std::optional<uint> asked) {
    SCOPED_TRACE((asked ? std::to_string(*asked) + " of " : "all of ") + std::to_string(most));
    const std::uint32_t count = std::min(asked.value_or(most), most);
    BuildOptions options;
    options.lookback = GetParam();
    CountedRun run;
    const ScanPlan plan = plan_scan(run.layout, most, options);
    run.start(asked.value_or(0));
    std::vector<uint> words = many_words(plan.source.count * 4);
    run.executor->upload(ScanPlan::words_of(plan.source), std::span<const uint>(words));
    run.fill(plan.target);
    run.expect_same_bits(
        [&](Chain& chain) { append_scan(chain, plan, asked ? chain.at(run.count) : UintBuffer{}); });
    if (HasFatalFailure()) return;
    std::exclusive_scan(words.begin(), words.begin() + count, words.begin(), 0u);
    std::fill(words.begin() + count, words.end(), SENTINEL);
    EXPECT_EQ(run.read(ScanPlan::words_of(plan.target)), words);
    expect_state(run.read(plan.state)[0], asked.value_or(most), most);
  }
};

TEST_P(DeviceCountsScan, EveryCountUpToFortyAndBeyondTheMaximum) {
  for (uint asked = 0; asked <= 40; ++asked) expect_scanned(37, asked);
  for (const uint asked : {0u, 1u}) expect_scanned(0, asked);
}

TEST_P(DeviceCountsScan, AboutTheEndsOfRunsAndTiles) {
  constexpr std::uint32_t run = SCAN_RUN * 4, tile = SCAN_TILE * 4, most = 5 * tile + 2;
  for (const std::uint32_t end : {run, tile, 3 * tile, 5 * tile}) {
    for (const int off : {-4, -3, -1, 0, 1, 2}) expect_scanned(most, end + off);
  }
  expect_scanned(most, most + 1);
}

// The words behind the last one are in the last quad, and neither summed up nor written.
TEST_P(DeviceCountsScan, AlsoWithoutACountOnTheDeviceNothingBehindTheLastWord) {
  for (const std::uint32_t most :
       {1u, 2u, 3u, 5u, SCAN_TILE * 4 - 1, SCAN_TILE * 4 + 1, 3 * SCAN_TILE * 4 + 2})
    expect_scanned(most, std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Lookback, DeviceCountsScan, testing::Bool(),
                         [](const auto& info) { return info.param ? "lookback" : "without_lookback"; });

// --- The build.

class DeviceCountsBuild : public DeviceCounts {
 protected:
  static void expect_tree(std::span<const Triangle> triangles, uint asked, const BuildOptions& options) {
    SCOPED_TRACE(std::to_string(asked) + " of " + std::to_string(triangles.size()));
    const auto most = static_cast<std::uint32_t>(triangles.size());
    CountedRun run;
    const BuildPlan plan = plan_build(run.layout, most, options);
    run.start(asked);
    run.executor->upload(plan.triangles, triangles);
    run.fill(plan.nodes);
    run.expect_same_bits([&](Chain& chain) { append_build(chain, plan, {.count_at = chain.at(run.count)}); });
    if (HasFatalFailure()) return;
    const BuildState state = run.read(plan.state)[0];
    expect_state(state, asked, most);
    if (asked > most) {
      EXPECT_EQ(state.active_count, 0u) << "a trace would walk a part of what was asked for";
      return;
    }
    const BuiltTree alone = build_on(test_device(), triangles.first(asked), options);
    EXPECT_EQ(state.active_count, alone.state.active_count);
    EXPECT_EQ(state.round_count, alone.state.round_count);
    std::vector<Node> nodes = run.read(plan.nodes);
    for (std::size_t i = alone.nodes.size(); i < nodes.size(); ++i) ASSERT_EQ(nodes[i].child, SENTINEL) << i;
    nodes.resize(alone.nodes.size());
    EXPECT_EQ(tree_hash(nodes), tree_hash(alone.nodes));
  }
};

TEST_F(DeviceCountsBuild, TheTreeOfAsManyTrianglesByEveryBuilder) {
  std::vector<Triangle> triangles = random_triangles(3000, 11);
  for (std::size_t i = 0; i < triangles.size(); i += 17) triangles[i].b.y = std::nanf("");
  for (const NamedDeviceBuilder& builder : device_builders()) {
    for (const bool lookback : {true, false}) {
      BuildOptions options;
      options.builder = builder.builder;
      options.lookback = lookback;
      for (const uint asked : {0u, 1u, 2u, 3u, 511u, 512u, 1024u, 1025u, 2999u, 3000u, 3001u, ~0u})
        expect_tree(triangles, asked, options);
    }
  }
}

TEST_F(DeviceCountsBuild, OfManyTilesOfTheSort) {
  const std::vector<Triangle> triangles = random_triangles(3 * SORT_RUNS_TILE, 12);
  for (const std::uint32_t sort : {SORT_SCAN, SORT_ONESWEEP_RUNS, SORT_ONESWEEP_MATCH}) {
    BuildOptions options;
    options.radius = 2;
    options.variants.sort = sort;
    for (const uint asked : {1000u, SORT_RUNS_TILE, 2 * SORT_RUNS_TILE + 1})
      expect_tree(triangles, asked, options);
  }
}

// What comes behind a build takes its number from the state.
TEST_F(DeviceCountsBuild, WideNodesOfACountedTree) {
  const std::vector<Triangle> triangles = random_triangles(3000, 13);
  const auto wide_of = [&](std::uint32_t most, std::optional<uint> asked) {
    CountedRun run;
    BuildPlan plan = plan_build(run.layout, most, {});
    const WidePlan wide = plan_wide(run.layout, plan, &plan);
    run.start(asked.value_or(0));
    run.upload(plan.triangles, std::vector<Triangle>(triangles.begin(), triangles.begin() + most));
    run.expect_same_bits([&](Chain& chain) {
      append_build(chain, plan, {.count_at = asked ? chain.at(run.count) : UintBuffer{}});
      append_wide(chain, plan, wide);
    });
    std::vector<WideNode> nodes = run.read(plan.wide_nodes);
    nodes.resize(run.read(plan.wide_counts)[0].node_count);
    return nodes;
  };
  const std::vector<WideNode> counted = wide_of(3000, 1001), alone = wide_of(1001, std::nullopt);
  ASSERT_EQ(counted.size(), alone.size());
  ASSERT_GT(counted.size(), 100u);
  EXPECT_EQ(std::memcmp(counted.data(), alone.data(), counted.size() * sizeof(WideNode)), 0);
}

TEST_F(DeviceCountsBuild, NonePlanned) {
  for (const NamedDeviceBuilder& builder : device_builders()) {
    BuildOptions options;
    options.builder = builder.builder;
    for (const uint asked : {0u, 5u}) expect_tree({}, asked, options);
  }
}

}  // namespace
}  // namespace coppice
