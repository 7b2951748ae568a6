#include "apps/report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/tree_hash.h"
#include "scene/write_file.h"

namespace coppice {

Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
  return {median, values.front(), values.back()};
}

Json coordinates(glm::dvec3 point) { return {point.x, point.y, point.z}; }
namespace {

// Names of files and devices need not be UTF-8, JSON must be: what is none becomes U+FFFD.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

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
  if (!report.ploc_rounds.empty()) json["ploc_rounds"] = to_json(report.ploc_rounds);
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

void print_build(const BuildReport& report) {
  std::printf("%s: %llu triangles", report.scene.c_str(), static_cast<unsigned long long>(report.triangles));
  if (report.inactive) std::printf(" (%llu inactive)", static_cast<unsigned long long>(report.inactive));
  std::printf(", %s on %s%s%s\n", report.builder.c_str(), report.device.c_str(),
              report.driver.empty() ? "" : ", ", report.driver.c_str());
  if (!report.kernels.rows.empty()) print_kernels(report.kernels);
  if (!report.ploc_rounds.empty()) print_rounds(report.ploc_rounds);
  std::printf("  build %.3f ms (%.3f to %.3f in %u runs)", report.build_ms.median, report.build_ms.least,
              report.build_ms.greatest, report.runs);
  if (report.rounds_bound) std::printf(", %u rounds of at most %u", report.rounds, report.rounds_bound);
  std::printf("\n  tree %s: %llu nodes, depth %u, SAH cost %.3f%s\n", hex16(report.tree_hash).c_str(),
              static_cast<unsigned long long>(report.quality.nodes), report.quality.depth, report.quality.sah,
              report.reference_cap_reached ? ", cap on references reached" : "");
  if (report.wide.nodes == 0) return;
  std::printf("  wide %.3f ms (%.3f to %.3f), %.1f %% of the build\n", report.wide_ms.median,
              report.wide_ms.least, report.wide_ms.greatest,
              100 * report.wide_ms.median / report.build_ms.median);
  std::printf("  wide tree: %llu nodes, %.2f children each, %u levels, SAH cost %.3f\n",
              static_cast<unsigned long long>(report.wide.nodes), report.wide.children_per_node(),
              report.wide.levels, report.wide.sah);
}

void write_json(const std::string& path, const Json& json) {
  if (path.empty()) return;
  const std::string text = text_of(json, 2) + "\n";
  if (path == "-") {
    std::fputs(text.c_str(), stdout);  // main says it if that fails
  } else {
    write_file(path, text);
  }
}

void TraceEvents::add(std::span<const Step> steps, const Recorder::Times& times) {
  for (std::size_t i = 0; i < times.steps_ms.size(); ++i) {
    if (events_.size() < most_events) {
      events_.push_back({step_name(steps[i]), times.steps_ms[i]});
    } else {
      ++left_out_;
    }
  }
}

void TraceEvents::write(const std::string& path) const {
  if (path.empty()) return;
  if (left_out_ > 0) {
    std::fprintf(stderr, "note: %s: the first %zu events, without %llu more\n", path.c_str(), events_.size(),
                 static_cast<unsigned long long>(left_out_));
  }
  std::string text = "{\"traceEvents\":[";
  double start_us = 0;
  for (const Event& event : events_) {
    const Json json = {{"name", event.name},     {"ph", "X"}, {"ts", start_us},
                       {"dur", event.ms * 1000}, {"pid", 1},  {"tid", 1}};
    if (&event != events_.data()) text += ',';
    text += json.dump();
    start_us += event.ms * 1000;
  }
  write_file(path, text + "],\"displayTimeUnit\":\"ms\"}\n");
}

}  // namespace coppice
