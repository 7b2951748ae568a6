#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/json.h"

namespace coppice {

// What one builder achieved on one scene.
struct ComparisonRow {
  std::string builder;
  std::string infeasible;  // why there are no figures; empty where there are
  double build_ms = 0, frame_ms = 0, sah = 0, mrays_per_s = 0, steps_per_ray = 0;
  std::uint64_t depth = 0, references = 0, node_bytes = 0;
  std::string tree_hash;
  std::optional<bool> lookback;  // of what a device built
};

struct SceneComparison {
  std::string scene;
  std::uint64_t triangles = 0;
  std::vector<ComparisonRow> rows;
};

// The row of a `render` report.
ComparisonRow comparison_row(const std::string& builder, const Json& render);

// A table a scene, with the factors against the fastest build and the best tree (least frame time); X where
// infeasible.
std::string to_markdown(const std::vector<SceneComparison>& scenes, const std::string& conditions);
Json to_json(const std::vector<SceneComparison>& scenes);

// Build time against frame time, both logarithmic, as SVG.
std::string to_svg(const std::vector<SceneComparison>& scenes);

}  // namespace coppice
