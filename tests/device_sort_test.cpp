// Every variant of the sort leaves the bits of its twins, and the order of std::stable_sort.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "interface/sort.h"
#include "stages/lockstep_executor.h"
#include "support/random_scenes.h"
#include "support/test_device.h"

namespace coppice {
namespace {

struct SortCase {
  std::uint32_t variant;
  std::uint32_t key_words;
};

std::vector<uint> keys_of(std::uint32_t count, std::uint32_t key_words, uint mask) {
  Random random(count);
  std::vector<uint> keys(std::size_t{count} * key_words);
  for (uint& key : keys) key = random.next() % 16 == 0 ? ~0u : random.next() & mask;
  return keys;
}

std::vector<uint> stable_order(const std::vector<uint>& keys, std::uint32_t key_words) {
  std::vector<uint> order(keys.size() / key_words);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](uint i) {
    return key_words == 1 ? keys[i] : std::uint64_t{keys[2 * i + 1]} << 32 | keys[2 * i];
  });
  return order;
}

class DeviceSort : public DeviceTest, public testing::WithParamInterface<SortCase> {
 protected:
  static void expect_sorted(std::uint32_t count, uint mask, bool has_values = true) {
    SCOPED_TRACE(std::to_string(count) + (has_values ? " pairs" : " keys alone"));
    const std::uint32_t key_words = GetParam().key_words;
    BuildOptions options;
    options.morton_bits = 30 * key_words;
    options.variants.sort = GetParam().variant;
    Layout layout(test_device().properties().max_block_bytes);
    const BuildPlan plan = plan_sort(layout, count, options, has_values);
    LockstepExecutor executor(test_device(), layout);
    const std::vector<uint> keys = keys_of(count, key_words, mask);
    std::vector<uint> values(has_values ? count : 0);
    std::iota(values.begin(), values.end(), 1000u);
    executor.upload(plan.unsorted_keys, std::span<const uint>(keys));
    executor.upload(plan.unsorted_values, std::span<const uint>(values));
    const auto difference = executor.run([&](Chain& chain) { append_sort(chain, plan); });
    ASSERT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                             << "]: cpu " << difference->cpu << ", gpu " << difference->gpu;
    std::vector<uint> sorted_keys, sorted_values;
    for (const uint i : stable_order(keys, key_words)) {
      sorted_keys.insert(sorted_keys.end(), &keys[i * key_words], &keys[i * key_words] + key_words);
      if (has_values) sorted_values.push_back(values[i]);
    }
    EXPECT_EQ(executor.gpu().read(plan.keys[0]), sorted_keys);
    EXPECT_EQ(executor.gpu().read(plan.values[0]), sorted_values);
  }

  static std::uint32_t tile_keys() {
    BuildOptions options;
    options.variants.sort = GetParam().variant;
    Layout layout;
    return plan_sort(layout, 1, options).sort.tile_keys;
  }
};

TEST_P(DeviceSort, SizesUpTo140) {
  for (std::uint32_t count = 0; count <= 140; ++count) expect_sorted(count, ~0u);
}

TEST_P(DeviceSort, SizesAboutOneToThreeTiles) {
  for (const std::uint32_t tiles : {1u, 2u, 3u}) {
    for (const std::uint32_t count : {tiles * tile_keys() - 1, tiles * tile_keys(), tiles * tile_keys() + 1,
                                      tiles * tile_keys() + tile_keys() / 3})
      expect_sorted(count, ~0u);
  }
}

TEST_P(DeviceSort, KeysAlone) {
  for (const std::uint32_t count : {0u, 1u, 63u, 300u, tile_keys() + 1, 2 * tile_keys() + 77})
    expect_sorted(count, ~0u, false);
}

TEST_P(DeviceSort, FewDifferentKeys) {
  for (const uint mask : {0u, 1u, 0x00100800u}) expect_sorted(2 * tile_keys() + 77, mask);
}

TEST_P(DeviceSort, AThirdOfAMillion) { expect_sorted(333333, ~0u); }

std::vector<SortCase> sort_cases() {
  std::vector<SortCase> cases;
  const auto variants = static_cast<std::uint32_t>(variant_stages()[0].values.size());
  for (std::uint32_t variant = 0; variant < variants; ++variant) {
    for (const std::uint32_t key_words : {1u, 2u}) cases.push_back({variant, key_words});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Variants, DeviceSort, testing::ValuesIn(sort_cases()), [](const auto& info) {
  std::string name(variant_stages()[0].values[info.param.variant]);
  std::ranges::replace(name, '-', '_');
  return name + (info.param.key_words == 1 ? "_32" : "_64");
});

class PlannedSort : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PlannedSort, ManyKeysTakeNarrowDigitsAndAllTakeABoundedNumberOfTiles) {
  const auto sort_of = [&](std::uint32_t count) {
    BuildOptions options;
    options.morton_bits = 60;
    options.variants.sort = GetParam();
    Layout layout(std::uint64_t{1} << 40);
    return plan_sort(layout, count, options).sort;
  };
  const bool onesweep = GetParam() == SORT_ONESWEEP_RUNS || GetParam() == SORT_ONESWEEP_MATCH;
  for (const std::uint32_t count : {0u, 1u, 5000u, 1000000u, max_triangles}) {
    const SortPlan sort = sort_of(count);
    EXPECT_EQ(sort.onesweep, onesweep);
    EXPECT_GE(sort.passes_per_word * sort.digit_bits, 32u);
    EXPECT_EQ(sort.passes, 2 * sort.passes_per_word);
    EXPECT_GE(std::uint64_t{sort.tile_count} * sort.tile_keys, count);
    EXPECT_LE(sort.tile_count, onesweep ? 65535u : 1024u);
  }
  const bool by_size = GetParam() == SORT_SCAN;
  EXPECT_EQ(sort_of(1000).digit_bits, by_size || GetParam() == SORT_SCAN_11 ? 11u : 8u);
  EXPECT_EQ(sort_of(1000000).digit_bits, GetParam() == SORT_SCAN_11 ? 11u : 8u);
}

INSTANTIATE_TEST_SUITE_P(Variants, PlannedSort,
                         testing::Range(0u, static_cast<std::uint32_t>(SORT_ONESWEEP_MATCH) + 1));

}  // namespace
}  // namespace coppice
