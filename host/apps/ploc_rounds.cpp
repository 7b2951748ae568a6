#include "apps/ploc_rounds.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "stages/stages.h"

namespace coppice {

namespace {

template <class Args>
std::uint32_t round_in(const Step& step) {
  Args args;
  std::memcpy(&args, step.args.data(), sizeof args);
  return args.round;
}

PlocRoundTime row_of(const std::vector<PlocRound>& rounds, std::size_t first, std::size_t end) {
  const PlocRound &from = rounds.at(first), &to = rounds.at(end);
  return {static_cast<std::uint32_t>(first), from.cluster_count, to.merged_before - from.merged_before,
          from.pair_all != 0, std::nullopt};
}

}  // namespace

std::vector<PlocRoundTime> ploc_round_times(const KernelSplit& split, const RunCounts& counts) {
  std::vector<PlocRoundTime> rows;
  for (std::size_t i = 0; i < split.times.steps_ms.size(); ++i) {
    const Step& step = split.steps[i];
    const double ms = split.times.steps_ms[i];
    if (step.stage == &stages::ploc_nearest) {
      const std::uint32_t round = round_in<PlocNearestArgs>(step);
      rows.push_back(row_of(counts.rounds, round, round + 1));
      rows.back().nearest_ms = ms;
    } else if (step.stage == &stages::ploc_merge || step.stage == &stages::ploc_tile_counts ||
               step.stage == &stages::ploc_tile_scan) {
      rows.back().merge_ms += ms;
    } else if (step.stage == &stages::ploc_finish) {
      rows.push_back(row_of(counts.rounds, rows.size(), counts.rounds.size() - 1));
      rows.back().merge_ms = ms;
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
                    {"nearest_ms", row.nearest_ms ? Json(*row.nearest_ms) : Json(nullptr)},
                    {"merge_ms", row.merge_ms}});
  }
  return rows;
}

void print_rounds(const std::vector<PlocRoundTime>& rounds) {
  std::printf("  %-7s %10s %10s %8s %11s %10s\n", "round", "clusters", "merged", "share", "nearest ms",
              "merge ms");
  for (const PlocRoundTime& row : rounds) {
    const std::string name = std::to_string(row.round) + (row.nearest_ms ? "" : " on");
    std::printf("  %-7s %10u %10u %7.1f%%", name.c_str(), row.clusters, row.merged,
                row.clusters ? 100.0 * row.merged / row.clusters : 0.0);
    if (row.nearest_ms) {
      std::printf(" %11.3f %10.3f%s\n", *row.nearest_ms, row.merge_ms, row.pair_all ? "  pairs all" : "");
    } else {
      std::printf(" %22.3f  ploc_finish, all rounds from here\n", row.merge_ms);
    }
  }
}

}  // namespace coppice
