#include <chrono>
#include <numeric>

#include "measure/bench.h"
#include "pipeline/scan_plan.h"
#include "scene/random.h"
#include "stages/errors.h"
#include "stages/gpu_executor.h"

namespace coppice {

namespace {

double scan_on_host(const std::vector<uint>& words, std::vector<uint>& sums) {
  const auto start = std::chrono::steady_clock::now();
  std::exclusive_scan(words.begin(), words.end(), sums.begin(), 0u);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

BenchRow bench_words(CheckedDevice& device, const BenchOptions& options, std::uint32_t count) {
  Random random(1);
  std::vector<uint> words(count), expected(count);
  for (uint& word : words) word = random.next();
  Layout layout(device.properties().max_block_bytes);
  const ScanPlan plan = plan_scan(layout, count, device.build_options(options.builder.build_options(30)));
  GpuExecutor executor(device.device(), layout);
  executor.upload(ScanPlan::words_of(plan.source), std::span<const uint>(words));
  Chain chain = executor.chain();
  append_scan(chain, plan);
  Recorder recorder = executor.record(chain.steps());
  recorder.submit_and_wait(measured_limit_seconds);
  const std::string error = describe_error_word(executor.read(plan.state)[0].error_word);
  if (!error.empty()) throw DeviceError(error);
  scan_on_host(words, expected);
  if (executor.read(Slot<uint>{plan.target.place, count}) != expected)
    throw DeviceError("scan of " + std::to_string(count) + " words: not the sums of std::exclusive_scan");

  // In turns, so that both meet the same machine.
  std::vector<double> host_ms;
  const auto run = [&] {
    host_ms.push_back(scan_on_host(words, expected));
    return recorder.submit_and_wait(measured_limit_seconds).total_ms;
  };
  const SteadyTime time = measure_steady(steady_options(options, run()), run);
  BenchRow row = bench_row("scan", "random", count, time);
  host_ms.erase(host_ms.begin(), host_ms.end() - row.runs);
  const double host_median = spread_of(host_ms).median;
  row.figures = {{"std_exclusive_scan_ms", host_median}, {"times_std", row.ms.median / host_median}};
  row.note = format("%.2f times std::exclusive_scan", row.ms.median / host_median);
  return row;
}

}  // namespace

void bench_scan(CheckedDevice& device, const BenchOptions& options, const AddRow& add) {
  if (!is_wanted(options, "scan", "random")) return;
  for (const std::uint32_t count : bench_sizes(1024, options.most)) add(bench_words(device, options, count));
}

}  // namespace coppice
