#include <algorithm>
#include <numeric>

#include "measure/bench.h"
#include "measure/copy_limit.h"
#include "measure/measure_build.h"
#include "scene/random.h"

namespace coppice {

namespace {

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

// Keys that ascend, each with the value that it came with, equal ones in the order in which they came: there
// is only one such order. Without values: the keys that std::sort gives.
bool is_sorted_stably(const GpuExecutor& executor, const BuildPlan& plan, const std::vector<uint>& keys,
                      std::uint32_t key_words) {
  const std::vector<uint> sorted = executor.read(plan.keys[0]), values = executor.read(plan.values[0]);
  const std::size_t count = plan.triangle_count;
  if (values.empty()) {
    std::vector<std::uint64_t> expected(count);
    for (std::size_t i = 0; i < count; ++i) expected[i] = key_at(keys, i, key_words);
    std::ranges::sort(expected);
    for (std::size_t i = 0; i < count; ++i) {
      if (key_at(sorted, i, key_words) != expected[i]) return false;
    }
    return true;
  }
  std::vector<bool> seen(count);
  for (std::size_t i = 0; i < count; ++i) {
    const uint value = values[i];
    if (value >= count || seen[value]) return false;
    seen[value] = true;
    const std::uint64_t key = key_at(sorted, i, key_words);
    if (key != key_at(keys, value, key_words)) return false;
    if (i == 0) continue;
    const std::uint64_t before = key_at(sorted, i - 1, key_words);
    if (before > key || (before == key && values[i - 1] > value)) return false;
  }
  return true;
}

Slot<uvec4> quads_of(const Slot<uint>& slot) { return {slot.place, slot.bytes() / sizeof(uvec4)}; }

std::string sort_name(std::uint32_t key_words, bool has_values) {
  return std::string(has_values ? "sort_pairs_" : "sort_keys_") + (key_words == 1 ? "32" : "64");
}

}  // namespace

BenchRow bench_keys(CheckedDevice& device, const BenchOptions& options, std::uint32_t count,
                    std::uint32_t key_words, bool has_values, const std::string& preset) {
  Layout layout(device.properties().max_block_bytes);
  const BuildPlan plan = plan_sort(
      layout, count, device.build_options(options.builder.build_options(30 * key_words)), has_values);
  const auto given_keys = layout.add<uint>("given_keys", plan.keys[0].count);
  const auto given_values = layout.add<uint>("given_values", plan.values[0].count);
  GpuExecutor executor(device.device(), layout);
  const std::vector<uint> keys = keys_of(preset, count, key_words);
  std::vector<uint> values(given_values.count);
  std::iota(values.begin(), values.end(), 0u);
  executor.upload(given_keys, std::span<const uint>(keys));
  executor.upload(given_values, std::span<const uint>(values));

  Chain copies = executor.chain();  // the sort ends where it began, so each run fetches its keys anew
  append_copy(copies, {quads_of(given_keys), quads_of(plan.unsorted_keys)}, 2 * given_keys.bytes());
  append_copy(copies, {quads_of(given_values), quads_of(plan.unsorted_values)}, 2 * given_values.bytes());
  Chain sort = executor.chain();
  append_sort(sort, plan);
  Recorder fetch = executor.record(copies.steps()), recorder = executor.record(sort.steps());
  const auto run = [&] {
    fetch.submit_and_wait(measured_limit_seconds);
    return recorder.submit_and_wait(measured_limit_seconds).total_ms;
  };
  run();
  check_state(executor, plan);
  if (!is_sorted_stably(executor, plan, keys, key_words))
    throw DeviceError(sort_name(key_words, has_values) + " of " + std::to_string(count) + " keys, " + preset +
                      ": wrong order");
  return bench_row(sort_name(key_words, has_values), preset, count,
                   measure_steady(steady_options(options, run()), run));
}

void bench_sort(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  for (const bool has_values : {true, false}) {
    for (const std::uint32_t key_words : {1u, 2u}) {
      for (const char* preset : {"random", "few-bits", "all-equal", "sorted"}) {
        if (!is_wanted(options, sort_name(key_words, has_values), preset)) continue;
        for (const std::uint32_t count : bench_sizes(1024, std::max(options.most / 4 * 4, 4u)))
          add(bench_keys(device, options, count, key_words, has_values, preset));
      }
    }
  }
}

}  // namespace coppice
