#include "measure/comparison.h"

#include <nlohmann/json.hpp>

#include "measure/comparison_text.h"
#include "measure/table.h"
#include "pipeline/build_plan.h"

namespace coppice {

namespace {

// The least positive value over the feasible rows; 0 if there is none.
double least(const std::vector<ComparisonRow>& rows, double ComparisonRow::*member) {
  double least = 0;
  for (const ComparisonRow& row : rows) {
    const double value = row.*member;
    if (row.infeasible.empty() && value > 0 && (least == 0 || value < least)) least = value;
  }
  return least;
}

std::string factor(double value, double best) {
  return value > 0 && best > 0 ? format("%.2f", value / best) : "-";
}

Table columns_of_comparison() {
  constexpr unsigned both = IN_JSON | IN_MARKDOWN;
  return Table({{.key = "builder", .heading = "builder", .places = both},
                {.key = "infeasible", .places = IN_JSON},
                {.key = "build_ms", .heading = "build ms", .precision = 1, .places = both},
                {.heading = "x fastest", .places = IN_MARKDOWN},
                {.key = "frame_ms", .heading = "frame ms", .precision = 1, .places = both},
                {.key = "fps", .heading = "FPS", .precision = 2, .places = both},
                {.heading = "x best", .places = IN_MARKDOWN},
                {.key = "sah", .heading = "SAH cost", .precision = 2, .places = both},
                {.key = "depth", .heading = "depth", .places = both},
                {.key = "references", .heading = "references", .places = both},
                {.key = "node_bytes", .places = IN_JSON},
                {.heading = "nodes MB", .precision = 1, .places = IN_MARKDOWN},
                {.key = "mrays_per_s", .heading = "Mrays/s", .precision = 2, .places = both},
                {.key = "steps_per_ray", .heading = "steps/ray", .precision = 1, .places = both},
                {.key = "tree_hash", .places = IN_JSON},
                {.key = "lookback", .places = IN_JSON}});
}

Table table_of(const SceneComparison& scene) {
  const double fastest = least(scene.rows, &ComparisonRow::build_ms);
  const double best = least(scene.rows, &ComparisonRow::frame_ms);
  Table table = columns_of_comparison();
  for (const ComparisonRow& row : scene.rows) {
    if (!row.infeasible.empty()) {
      const std::string reason = "X (" + markdown_text(row.infeasible) + ")";
      table.add({{row.builder,
                  row.infeasible,
                  Cell().shown_as(reason),
                  {},
                  Cell().shown_as("X"),
                  Cell().shown_as("X")}});
      continue;
    }
    table.add({{row.builder,
                {},
                row.build_ms,
                factor(row.build_ms, fastest),
                row.frame_ms,
                1000 / row.frame_ms,
                factor(row.frame_ms, best),
                row.sah,
                row.depth,
                row.references,
                row.node_bytes,
                static_cast<double>(row.node_bytes) * 1e-6,
                row.mrays_per_s,
                row.steps_per_ray,
                row.tree_hash,
                row.lookback ? Cell(*row.lookback) : Cell()}});
  }
  return table;
}

}  // namespace

ComparisonRow comparison_row(const std::string& builder, const Json& render) {
  constexpr std::uint64_t bytes_a_node = 32;
  const Json& build = render.at("build");
  ComparisonRow row;
  row.builder = builder;
  // Without a tree there was nothing to build, and no build is the fastest.
  row.build_ms = build.at("nodes") == 0 ? 0.0 : build.at("build_ms").get<double>();
  row.frame_ms = render.at("trace_ms");
  row.sah = build.at("sah");
  row.mrays_per_s = render.at("mrays_per_s");
  row.steps_per_ray = render.at("steps_per_ray");
  row.depth = build.at("depth");
  row.references = build.at("references");
  row.node_bytes = build.at("nodes").get<std::uint64_t>() * bytes_a_node;
  row.tree_hash = build.at("tree_hash");
  if (build.contains("lookback") && find_device_builder(builder)) row.lookback = build["lookback"];
  return row;
}

std::string to_markdown(const std::vector<SceneComparison>& scenes, const std::string& conditions) {
  std::string text = markdown_text(conditions) + "\n";
  for (const SceneComparison& scene : scenes) {
    text += format("\n### %s, %llu triangles\n\n", markdown_text(scene.scene).c_str(),
                   static_cast<unsigned long long>(scene.triangles));
    text += table_of(scene).markdown();
  }
  return text;
}

Json to_json(const std::vector<SceneComparison>& scenes) {
  Json list = Json::array();
  for (const SceneComparison& scene : scenes)
    list.push_back(
        {{"scene", scene.scene}, {"triangles", scene.triangles}, {"builders", table_of(scene).json()}});
  return list;
}

}  // namespace coppice
