#include "measure/copy_limit.h"

#include <algorithm>

#include "stages/divide_up.h"
#include "stages/gpu_executor.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr std::uint64_t quad_bytes = 2 * sizeof(uvec4);  // read and written
constexpr std::uint64_t least_bytes = 4 << 10, greatest_bytes = 256 << 20;
constexpr std::size_t runs = 5;
constexpr double copy_limit_seconds = 60;

std::uint64_t quads_of(std::uint64_t bytes) { return divide_up(bytes, quad_bytes); }

}  // namespace

CopyPlan plan_copy(Layout& layout, std::uint64_t most_bytes) {
  return {layout.add<uvec4>("copy_source", quads_of(most_bytes)),
          layout.add<uvec4>("copy_target", quads_of(most_bytes))};
}

void append_copy(Chain& chain, const CopyPlan& plan, std::uint64_t bytes) {
  const auto quads = static_cast<std::uint32_t>(std::min(quads_of(bytes), plan.source.count));
  chain.run(stages::copy_words, {chain.at(plan.source), chain.at(plan.target), quads, 0},
            {divide_up(quads, COPY_TILE), 1, 1});
}

double CopyLimit::ms(std::uint64_t bytes) const {
  const auto above = std::ranges::find_if(measurements_, [&](const auto& m) { return m.bytes >= bytes; });
  if (above == measurements_.begin()) return above->ms;
  const Measurement& below = *(above - 1);
  const auto distance = static_cast<double>(bytes - below.bytes);
  if (above == measurements_.end()) return below.ms * (1 + distance / static_cast<double>(below.bytes));
  return below.ms + (above->ms - below.ms) * distance / static_cast<double>(above->bytes - below.bytes);
}

CopyLimit measure_copy_limit(Device& device, std::uint64_t most_bytes) {
  if (device.properties().timestamp_period_ns == 0) throw DeviceError("a device without timestamps");
  std::vector<CopyLimit::Measurement> measurements{{least_bytes, 0}};
  while (measurements.back().bytes < std::min(most_bytes, greatest_bytes))
    measurements.push_back({measurements.back().bytes * 4, 0});
  Layout layout(device.properties().max_block_bytes);
  const CopyPlan plan = plan_copy(layout, measurements.back().bytes);
  GpuExecutor executor(device, layout);
  Chain chain = executor.chain();
  for (const auto& measurement : measurements) append_copy(chain, plan, measurement.bytes);
  Recorder recorder = executor.record(chain.steps(), Timestamps::every_step);
  recorder.submit_and_wait(copy_limit_seconds);
  std::vector<std::vector<double>> times(measurements.size());
  for (std::size_t run = 0; run < runs; ++run) {
    const std::vector<double> steps_ms = recorder.submit_and_wait(copy_limit_seconds).steps_ms;
    for (std::size_t i = 0; i < times.size(); ++i) times[i].push_back(steps_ms.at(i));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::ranges::nth_element(times[i], times[i].begin() + runs / 2);
    measurements[i].ms = times[i][runs / 2];
  }
  return CopyLimit(std::move(measurements));
}

}  // namespace coppice
