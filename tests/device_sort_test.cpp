// The sort by itself, of pairs and of keys alone: the bits of its twins, and the order that the standard
// library gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "interface/sort.h"
#include "pipeline/build.h"
#include "scene/random.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class DeviceSort : public DeviceTest {
 protected:
  // Keys of few digits, so that many are equal.
  static std::vector<std::uint64_t> keys_of(std::uint32_t count, std::uint32_t key_words) {
    Random random(count + 1);
    std::vector<std::uint64_t> keys(count);
    for (std::uint64_t& key : keys) {
      const std::uint64_t low = random.next() & 0x800f0307u, high = random.next() & 0xc0000101u;
      key = key_words == 1 ? low : high << 32 | low;
    }
    return keys;
  }

  static void expect_sorted(std::uint32_t count, const BuildOptions& options, bool has_values) {
    const std::uint32_t key_words = options.morton_bits / 30;
    std::vector<std::uint64_t> keys = keys_of(count, key_words);
    std::vector<uint> words, values(has_values ? count : 0);
    for (const std::uint64_t key : keys) {
      words.push_back(static_cast<uint>(key));
      if (key_words == 2) words.push_back(static_cast<uint>(key >> 32));
    }
    std::iota(values.begin(), values.end(), 0u);
    Layout layout(test_device().properties().max_block_bytes);
    const BuildPlan plan = plan_sort(layout, count, options, has_values);
    LockstepExecutor executor(test_device(), layout);
    executor.upload(plan.keys[0], std::span<const uint>(words));
    executor.upload(plan.values[0], std::span<const uint>(values));
    const auto difference = executor.run([&](Chain& chain) { append_sort(chain, plan); });
    ASSERT_FALSE(difference) << count << " keys: " << difference->stage << " " << difference->slot << "["
                             << difference->index << "]";

    std::ranges::stable_sort(values, {}, [&](uint i) { return keys[i]; });
    EXPECT_EQ(executor.gpu().read(plan.values[0]), values) << count << " keys";
    std::ranges::sort(keys);
    const std::vector<uint> sorted = executor.gpu().read(plan.keys[0]);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(sorted[i * key_words], static_cast<uint>(keys[i])) << i << " of " << count << " keys";
      if (key_words == 2) {
        ASSERT_EQ(sorted[2 * i + 1], static_cast<uint>(keys[i] >> 32)) << i << " of " << count << " keys";
      }
    }
  }
};

TEST_F(DeviceSort, PairsAndKeysAloneOfBothWidths) {
  for (const std::uint32_t bits : {30u, 60u}) {
    for (const bool lookback : {true, false}) {
      BuildOptions options;
      options.morton_bits = bits;
      options.lookback = lookback;
      for (const std::uint32_t count :
           {0u, 1u, 2u, 300u, SORT_TILE - 1, SORT_TILE, SORT_TILE + 1, 3 * SORT_TILE + 5}) {
        expect_sorted(count, options, true);
        expect_sorted(count, options, false);
      }
    }
  }
}

}  // namespace
}  // namespace coppice
