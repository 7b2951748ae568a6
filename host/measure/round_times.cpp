#include "measure/round_times.h"

#include <algorithm>
#include <utility>

#include "stages/stages.h"

namespace coppice {

namespace {

PlocRoundTime rounds_time(const std::vector<PlocRound>& rounds, std::size_t first, std::size_t end) {
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
      rows.push_back(rounds_time(counts.rounds, rows.size(), rows.size() + 1));
      rows.back().ms = std::exchange(before_merge_ms, 0.0) + ms;
    } else if (stage_of(step) == &stages::ploc_finish) {
      rows.push_back(rounds_time(counts.rounds, rows.size(), counts.rounds.size() - 1));
      rows.back().finish = true;
      rows.back().ms = ms;
    }
  }
  return rows;
}

Table table_of(const std::vector<PlocRoundTime>& rounds) {
  Table table({{.key = "round", .heading = "round", .width = -7, .gap = 2},
               {.key = "clusters", .heading = "clusters", .width = 10},
               {.key = "merged", .heading = "merged", .width = 10},
               {.heading = "share", .width = 8, .precision = 1, .places = IN_TEXT, .unit = "%"},
               {.key = "pair_all", .places = IN_JSON},
               {.key = "finish", .places = IN_JSON},
               {.key = "ms", .heading = "ms", .width = 10, .precision = 3}});
  for (const PlocRoundTime& row : rounds) {
    const double share = row.clusters ? 100.0 * row.merged / row.clusters : 0.0;
    const char* const remark = row.finish     ? "  ploc_finish, all rounds from here"
                               : row.pair_all ? "  pairs all"
                                              : "";
    table.add({{Cell(row.round).shown_as(std::to_string(row.round) + (row.finish ? " on" : "")), row.clusters,
                row.merged, share, row.pair_all, row.finish, row.ms},
               remark});
  }
  return table;
}

}  // namespace coppice
