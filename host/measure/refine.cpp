#include "measure/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/progress.h"

namespace coppice {

namespace {

// As many as were taken, at most, so that passes are few; less where less is expected to do.
std::uint32_t wanted_samples(const RefineLimits& limits, const Refined& so_far) {
  const double done = so_far.samples;
  double wanted = done;
  if (limits.error > 0 && std::isfinite(so_far.error)) {
    const double ratio = so_far.error / limits.error;
    wanted = std::min(wanted, std::ceil(done * ratio * ratio) - done);
  }
  if (limits.seconds > 0)
    wanted = std::min(wanted, (limits.seconds - so_far.seconds) / std::max(so_far.seconds, 1e-9) * done);
  return static_cast<std::uint32_t>(std::max(wanted, 1.0));
}

// Of what will end it, in percent.
std::uint32_t percent_of(const RefineLimits& limits, const Refined& so_far) {
  double part = static_cast<double>(so_far.samples) / limits.most_samples;
  if (limits.seconds > 0) part = std::max(part, so_far.seconds / limits.seconds);
  if (limits.error > 0 && so_far.error > 0)
    part = std::max(part, limits.error * limits.error / (so_far.error * so_far.error));
  return static_cast<std::uint32_t>(100 * std::clamp(part, 0.0, 1.0));
}

}  // namespace

const char* name_of(RefineEnd end) {
  constexpr const char* names[] = {"seconds", "error", "samples"};
  return names[static_cast<int>(end)];
}

std::uint32_t samples_of_next_pass(const RefineLimits& limits, Refined& so_far) {
  const std::uint32_t left = limits.most_samples - so_far.samples;
  if (so_far.samples == 0) return std::min(limits.seconds > 0 ? 1 : REFINE_LEAST_SAMPLES, left);
  const auto end = [&](RefineEnd by) {
    so_far.ended_by = by;
    return 0u;
  };
  if (limits.error > 0 && so_far.samples >= REFINE_LEAST_SAMPLES && so_far.error <= limits.error)
    return end(RefineEnd::error);
  if (limits.seconds > 0 && so_far.seconds >= limits.seconds) return end(RefineEnd::seconds);
  if (left == 0) return end(RefineEnd::samples);
  std::uint32_t next = wanted_samples(limits, so_far);
  if (limits.seconds == 0 && so_far.samples < REFINE_LEAST_SAMPLES)
    next = REFINE_LEAST_SAMPLES - so_far.samples;
  return std::min(next, left);
}

Refined refine(const RefineLimits& limits, const std::function<double(std::uint32_t, std::uint32_t)>& pass,
               const std::function<double(std::uint32_t)>& error) {
  Refined refined;
  refined.error = std::numeric_limits<double>::infinity();
  Progress progress("refining", 100);
  while (const std::uint32_t count = samples_of_next_pass(limits, refined)) {
    refined.seconds += pass(refined.samples, refined.samples + count);
    refined.samples += count;
    if (refined.samples >= 2) refined.error = error(refined.samples);
    progress.advance(percent_of(limits, refined));
  }
  return refined;
}

TracePlan plan_of_pass(const TracePlan& plan, std::uint32_t first_sample, std::uint32_t end_sample) {
  TracePlan pass = plan;
  pass.options.first_sample = first_sample;
  pass.options.samples = end_sample;
  pass.options.resolves = false;
  return pass;
}

}  // namespace coppice
