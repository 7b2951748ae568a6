#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace coppice {

// What repeated measurements say for one variant of a stage against the one of the rule.
struct TunedChoice {
  std::uint32_t fastest;  // by the least median
  std::uint32_t chosen;   // the fastest, or the rule's where that is not sure
  bool sure;              // whether measurement decided, and not noise
};

// By less a variant does not displace the one of the rule: it would not be noticed.
inline constexpr double least_gain = 0.05;

// `medians_ms`: of each variant the median of every turn; empty for one that cannot run. The fastest
// displaces the rule's variant only by more than either one's own spread: every turn of the one took less
// than every turn of the other. Then five turns each are ordered so by chance once in 252. It must gain
// least_gain besides.
inline TunedChoice choose_variant(std::span<const std::vector<double>> medians_ms, std::uint32_t rule) {
  const auto least = [&](std::uint32_t i) { return *std::ranges::min_element(medians_ms[i]); };
  const auto greatest = [&](std::uint32_t i) { return *std::ranges::max_element(medians_ms[i]); };
  const auto median = [&](std::uint32_t i) {
    std::vector<double> sorted = medians_ms[i];
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  };
  std::uint32_t fastest = rule;
  for (std::uint32_t i = 0; i < medians_ms.size(); ++i) {
    if (!medians_ms[i].empty() && median(i) < median(fastest)) fastest = i;
  }
  const bool sure = fastest == rule ||
                    (greatest(fastest) < least(rule) && median(fastest) <= median(rule) * (1 - least_gain));
  return {fastest, sure ? fastest : rule, sure};
}

}  // namespace coppice
