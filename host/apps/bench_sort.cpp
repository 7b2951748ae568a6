#include <algorithm>
#include <numeric>

#include "apps/bench.h"
#include "apps/measure_build.h"
#include "pipeline/copy_limit.h"
#include "scene/random.h"

namespace coppice {

namespace {

constexpr double limit_seconds = 120;

// Keys of `key_words` words, low word first.
std::vector<uint> keys_of(const std::string& preset, std::uint32_t count, std::uint32_t key_words) {
  Random random(1);
  std::vector<uint> keys(std::size_t{count} * key_words);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const uint key = random.next();
    if (preset == "random") keys[i] = key;
    if (preset == "few-bits")
      keys[i] = key & random.next() & random.next() & random.next();  // each bit 1 of 16
    if (preset == "all-equal") keys[i] = 0x12345678u;
    if (preset == "sorted") keys[i] = (i % key_words == 0) ? static_cast<uint>(i / key_words) : 0u;
  }
  return keys;
}

std::uint64_t key_at(const std::vector<uint>& keys, std::size_t i, std::uint32_t key_words) {
  return key_words == 1 ? keys[i] : std::uint64_t{keys[2 * i + 1]} << 32 | keys[2 * i];
}

// What std::stable_sort makes of the same pairs.
void check_sorted(const GpuExecutor& executor, const BuildPlan& plan, const std::vector<uint>& keys,
                  std::uint32_t key_words, const std::string& what) {
  std::vector<uint> order(plan.triangle_count);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](uint i) { return key_at(keys, i, key_words); });
  const std::vector<uint> sorted = executor.read(plan.keys[0]);
  bool right = executor.read(plan.values[0]) == order;
  for (std::size_t i = 0; i < order.size() && right; ++i)
    right = key_at(sorted, i, key_words) == key_at(keys, order[i], key_words);
  if (!right) throw DeviceError("sort of " + what + ": not the order of std::stable_sort");
}

Slot<uvec4> quads_of(const Slot<uint>& slot) { return {slot.place, slot.bytes() / sizeof(uvec4)}; }

}  // namespace

BenchRow bench_pairs(CheckedDevice& device, const Options& options, std::uint32_t count,
                     std::uint32_t key_words, const std::string& preset) {
  Layout layout(device.device.properties().max_block_bytes);
  const BuildPlan plan = plan_sort(layout, count, device.build_options(options, 30 * key_words));
  const auto given_keys = layout.add<uint>("given_keys", plan.keys[0].count);
  const auto given_values = layout.add<uint>("given_values", count);
  GpuExecutor executor(device.device, layout);
  const std::vector<uint> keys = keys_of(preset, count, key_words);
  std::vector<uint> values(count);
  std::iota(values.begin(), values.end(), 0u);
  executor.upload(given_keys, std::span<const uint>(keys));
  executor.upload(given_values, std::span<const uint>(values));

  Chain chain = executor.chain();  // the sort ends where it began, so each run fetches its pairs anew
  append_copy(chain, {quads_of(given_keys), quads_of(plan.unsorted_keys)}, 2 * given_keys.bytes());
  append_copy(chain, {quads_of(given_values), quads_of(plan.unsorted_values)}, 2 * given_values.bytes());
  chain.mark();
  append_sort(chain, plan);
  Recorder recorder = executor.record(chain.steps());
  recorder.submit_and_wait(limit_seconds);
  check_state(executor, plan);
  const std::string name = key_words == 1 ? "sort_pairs_32" : "sort_pairs_64";
  check_sorted(executor, plan, keys, key_words, std::to_string(count) + " pairs, " + preset);
  const SteadyTime time = measure_steady({.runs = options.runs}, [&] {
    const Recorder::Times times = recorder.submit_and_wait(limit_seconds);
    return times.total_ms - times.marks_ms.at(0);
  });
  return bench_row(name, preset, count, time);
}

void bench_sort(CheckedDevice& device, const Options& options, const AddRow& add) {
  for (const std::uint32_t key_words : {1u, 2u}) {
    for (const char* preset : {"random", "few-bits", "all-equal", "sorted"}) {
      for (const std::uint32_t count : bench_sizes(1024, std::max(options.most / 4 * 4, 4u)))
        add(bench_pairs(device, options, count, key_words, preset));
    }
  }
}

}  // namespace coppice
