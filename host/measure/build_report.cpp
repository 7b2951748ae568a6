#include "measure/build_report.h"

#include <nlohmann/json.hpp>

#include "analysis/tree_hash.h"
#include "measure/table.h"

namespace coppice {

Json to_json(const BuildReport& report) {
  Json json = {{"scene", report.scene},
               {"triangles", report.triangles},
               {"inactive", report.inactive},
               {"offset", coordinates(report.offset)},
               {"builder", report.builder},
               {"radius", report.radius},
               {"morton_bits", report.morton_bits},
               {"device", report.device},
               {"driver", report.driver},
               {"build_ms", report.build_ms.median},
               {"build_ms_min", report.build_ms.least},
               {"build_ms_max", report.build_ms.greatest},
               {"runs", report.runs},
               {"wall_ms", report.wall_ms.median}};
  if (!report.kernels.rows.empty() || report.kernels.untimed) {
    json["kernels"] = to_json(report.kernels);
    json["dispatches"] = report.kernels.untimed ? Json(nullptr) : Json(report.kernels.sum().dispatches);
    sums_to_json(report.kernels, json);
    json["variants"] = report.variants;
    if (!report.variants.empty()) json["lookback"] = report.lookback;
    json["device_bytes"] = report.device_bytes;
  }
  if (report.builder == "gd16-early") json["leaf_size"] = report.leaf_size;
  if (!report.ploc_rounds.empty()) json["ploc_rounds"] = table_of(report.ploc_rounds).json();
  json["rounds"] = report.rounds;
  json["rounds_bound"] = report.rounds_bound;
  json["nodes"] = report.quality.nodes;
  json["leaves"] = report.quality.leaves;
  json["depth"] = report.quality.depth;
  json["sah"] = report.quality.sah;
  json["references"] = report.quality.references;
  if (report.reference_cap_reached) json["reference_cap_reached"] = true;
  json["tree_hash"] = hex16(report.tree_hash);
  if (report.wide.nodes > 0) {
    json["wide"] = {{"ms", report.wide_ms.median},
                    {"ms_min", report.wide_ms.least},
                    {"ms_max", report.wide_ms.greatest},
                    {"nodes", report.wide.nodes},
                    {"children_per_node", report.wide.children_per_node()},
                    {"levels", report.wide.levels},
                    {"sah", report.wide.sah}};
  }
  return json;
}

std::string text_of(const BuildReport& report) {
  using Count = unsigned long long;
  std::string text = format("%s: %llu triangles", report.scene.c_str(), static_cast<Count>(report.triangles));
  if (report.inactive) text += format(" (%llu inactive)", static_cast<Count>(report.inactive));
  text += ", " + report.builder + " on " + report.device + (report.driver.empty() ? "" : ", ") +
          report.driver + "\n";
  if (!report.kernels.rows.empty()) text += text_of(report.kernels);
  if (!report.ploc_rounds.empty()) text += table_of(report.ploc_rounds).text();
  text += format("  build %.3f ms (%.3f to %.3f in %u runs)", report.build_ms.median, report.build_ms.least,
                 report.build_ms.greatest, report.runs);
  if (report.rounds_bound) text += format(", %u rounds of at most %u", report.rounds, report.rounds_bound);
  text += format("\n  tree %s: %llu nodes, depth %u, SAH cost %.3f%s\n", hex16(report.tree_hash).c_str(),
                 static_cast<Count>(report.quality.nodes), report.quality.depth, report.quality.sah,
                 report.reference_cap_reached ? ", cap on references reached" : "");
  if (report.wide.nodes == 0) return text;
  text += format("  wide %.3f ms (%.3f to %.3f), %.1f %% of the build\n", report.wide_ms.median,
                 report.wide_ms.least, report.wide_ms.greatest,
                 100 * report.wide_ms.median / report.build_ms.median);
  return text + format("  wide tree: %llu nodes, %.2f children each, %u levels, SAH cost %.3f\n",
                       static_cast<Count>(report.wide.nodes), report.wide.children_per_node(),
                       report.wide.levels, report.wide.sah);
}

}  // namespace coppice
