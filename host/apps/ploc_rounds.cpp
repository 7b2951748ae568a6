#include "apps/ploc_rounds.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "stages/stages.h"

namespace coppice {

namespace {

PlocRoundTime row_of(const std::vector<PlocRound>& rounds, std::size_t first, std::size_t end) {
  const PlocRound &from = rounds.at(first), &to = rounds.at(end);
  return {static_cast<std::uint32_t>(first), from.cluster_count, to.merged_before - from.merged_before,
          from.pair_all != 0, false};
}

}  // namespace

std::vector<PlocRoundTime> ploc_round_times(const KernelSplit& split, const RunCounts& counts) {
  std::vector<PlocRoundTime> rows;
  double before_merge_ms = 0;
  for (std::size_t i = 0; i < split.times.steps_ms.size(); ++i) {
    const Step& step = split.steps[i];
    const double ms = split.times.steps_ms[i];
    if (stage_of(step) == &stages::ploc_tile_counts || stage_of(step) == &stages::ploc_tile_scan) {
      before_merge_ms += ms;
    } else if (stage_of(step) == &stages::ploc_merge) {
      rows.push_back(row_of(counts.rounds, rows.size(), rows.size() + 1));
      rows.back().ms = std::exchange(before_merge_ms, 0.0) + ms;
    } else if (stage_of(step) == &stages::ploc_finish) {
      rows.push_back(row_of(counts.rounds, rows.size(), counts.rounds.size() - 1));
      rows.back().finish = true;
      rows.back().ms = ms;
    }
  }
  return rows;
}

Json to_json(const std::vector<PlocRoundTime>& rounds) {
  Json rows = Json::array();
  for (const PlocRoundTime& row : rounds) {
    rows.push_back({{"round", row.round},
                    {"clusters", row.clusters},
                    {"merged", row.merged},
                    {"pair_all", row.pair_all},
                    {"finish", row.finish},
                    {"ms", row.ms}});
  }
  return rows;
}

void print_rounds(const std::vector<PlocRoundTime>& rounds) {
  std::printf("  %-7s %10s %10s %8s %10s\n", "round", "clusters", "merged", "share", "ms");
  for (const PlocRoundTime& row : rounds) {
    const std::string name = std::to_string(row.round) + (row.finish ? " on" : "");
    const char* note = row.finish ? "  ploc_finish, all rounds from here" : row.pair_all ? "  pairs all" : "";
    std::printf("  %-7s %10u %10u %7.1f%% %10.3f%s\n", name.c_str(), row.clusters, row.merged,
                row.clusters ? 100.0 * row.merged / row.clusters : 0.0, row.ms, note);
  }
}

}  // namespace coppice
