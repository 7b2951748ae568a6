#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/tree_hash.h"
#include "measure/animate.h"
#include "measure/curves.h"
#include "measure/table.h"

namespace coppice {

namespace {

using FrameValue = double AnimatedFrame::*;

std::vector<double> values_of(const AnimateReport& report, FrameValue value) {
  std::vector<double> values;
  for (const AnimatedFrame& frame : report.frames) values.push_back(frame.*value);
  return values;
}

// The least value that so many percent of the values do not exceed.
double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double rank = std::ceil(percent / 100 * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

Json percentiles(const AnimateReport& report, FrameValue value) {
  const std::vector<double> values = values_of(report, value);
  return {{"p50", percentile(values, 50)},
          {"p95", percentile(values, 95)},
          {"p99", percentile(values, 99)},
          {"max", percentile(values, 100)}};
}

struct TimedPart {
  const char* name;
  const char* what;
  FrameValue value;
};

constexpr TimedPart timed_parts[] = {
    {"frame", "from picture to picture, by the host's clock", &AnimatedFrame::frame_ms},
    {"device", "of it on the device: one submit", &AnimatedFrame::device_ms},
    {"vertices", "to where they are, or instances", &AnimatedFrame::vertices_ms},
    {"build", "triangles to tree, built or refitted", &AnimatedFrame::update_ms},
    {"wide", "the tree with eight children a node", &AnimatedFrame::wide_ms},
    {"trace", "camera rays to picture", &AnimatedFrame::trace_ms}};

// One a frame from the first to the last, NaN where there is none.
std::vector<double> curve_of(const AnimateReport& report, FrameValue value) {
  std::vector<double> values;
  for (const AnimatedFrame& frame : report.frames) {
    values.resize(frame.number - report.frames.front().number, std::numeric_limits<double>::quiet_NaN());
    values.push_back(frame.*value);
  }
  return values;
}

}  // namespace

const char* word_of_update(Update update) {
  return update == Update::rebuild ? "rebuild" : update == Update::refit ? "refit" : "auto";
}

Json to_json(const AnimateReport& report) {
  Json hashes = Json::array(), numbers = Json::array();
  std::uint64_t rays = 0, shadow_rays = 0, occlusion_rays = 0;
  LobeCounts lobes;
  for (const AnimatedFrame& frame : report.frames) {
    rays += frame.rays;
    shadow_rays += frame.shadow_rays;
    occlusion_rays += frame.occlusion_rays;
    lobes.reflected += frame.lobes.reflected;
    lobes.transmitted += frame.lobes.transmitted;
    lobes.diffuse += frame.lobes.diffuse;
    hashes.push_back(hex16(frame.hash));
    numbers.push_back(frame.number);
  }
  Json json = {{"scene", report.scene},
               {"triangles", report.triangles},
               {"vertices", report.vertices},
               {"builder", report.builder},
               {"morton_bits", report.morton_bits},
               {"device", report.device},
               {"driver", report.driver},
               {"width", report.width},
               {"height", report.height},
               {"tree", is_wide(report.walk) ? "wide" : "binary"},
               {"frames_per_second", report.frames_per_second},
               {"frames", report.frames.size()},
               {"skipped", report.skipped},
               {"update", word_of_update(report.update)}};
  if (report.instances) json["instances"] = report.instances;
  for (const TimedPart& part : timed_parts)
    json[std::string(part.name) + "_ms"] = percentiles(report, part.value);
  const auto frames = static_cast<double>(std::max<std::size_t>(report.frames.size(), 1));
  for (const TriedTree& tree : report.tried)
    json["tried"].push_back({{"builder", tree.builder}, {"tree", name_of(tree.walk)}, {"frame_ms", tree.ms}});
  json["host_waits_per_frame"] = static_cast<double>(report.host_waits) / frames;
  if (report.tree_cost) {
    json["sah"] = Json::array();
    for (const AnimatedFrame& frame : report.frames) json["sah"].push_back(frame.sah);
  }
  json["rays"] = {{"primary", rays},
                  {"shadow", shadow_rays},
                  {"reflection", lobes.reflected},
                  {"refraction", lobes.transmitted},
                  {"occlusion", occlusion_rays},
                  {"diffuse", lobes.diffuse}};
  json["rebuilds"] = report.rebuilds;
  json["refits"] = report.refits;
  json["frame_numbers"] = numbers;
  json["frame_hashes"] = hashes;
  json["peak_device_bytes"] = report.device_bytes;
  json["kernels"] = to_json(report.kernels);
  sums_to_json(report.kernels, json);
  return json;
}

std::string text_of(const AnimateReport& report) {
  std::string text =
      format("%s: %llu triangles", report.scene.c_str(), static_cast<unsigned long long>(report.triangles));
  if (report.instances)
    text += format(" in %llu instances of meshes", static_cast<unsigned long long>(report.instances));
  text += format(", %zu frames of %ux%u by %s on %s, %s tree\n", report.frames.size(), report.width,
                 report.height, report.builder.c_str(), report.device.c_str(),
                 is_wide(report.walk) ? "wide" : "binary");
  text += format("  --update %s: %llu trees built, %llu refitted\n", word_of_update(report.update),
                 static_cast<unsigned long long>(report.rebuilds),
                 static_cast<unsigned long long>(report.refits));
  for (const TriedTree& tree : report.tried)
    text += format("  tried: %s, %s: %.2f ms\n", tree.builder.c_str(),
                   std::string(name_of(tree.walk)).c_str(), tree.ms);
  if (report.skipped) text += format("  %u frames are there already\n", report.skipped);
  if (report.frames.empty()) return text;
  Table table({{.heading = "ms", .width = -10, .gap = 2},
               {.heading = "p50", .width = 9, .precision = 2},
               {.heading = "p95", .width = 9, .precision = 2},
               {.heading = "p99", .width = 9, .precision = 2},
               {.heading = "max", .width = 9, .precision = 2}});
  for (const TimedPart& part : timed_parts) {
    const std::vector<double> values = values_of(report, part.value);
    table.add({{part.name, percentile(values, 50), percentile(values, 95), percentile(values, 99),
                percentile(values, 100)},
               std::string("  ") + part.what});
  }
  text += table.text();
  const double p50 = percentile(values_of(report, &AnimatedFrame::frame_ms), 50);
  text += format("  %.1f frames a second, %.1f MB on the device\n", p50 > 0 ? 1000 / p50 : 0,
                 static_cast<double>(report.device_bytes) / 1e6);
  if (report.tree_cost) {
    const std::vector<double> costs = values_of(report, &AnimatedFrame::sah);
    text += format("  SAH cost %.2f at first, %.2f at last, median %.2f, at most %.2f\n", costs.front(),
                   costs.back(), percentile(costs, 50), percentile(costs, 100));
  }
  if (!report.kernels.rows.empty()) text += text_of(report.kernels);
  return text;
}

std::string to_csv(const AnimateReport& report) {
  Table table({{.key = "frame", .places = IN_CSV},
               {.key = "frame_ms", .precision = 3, .places = IN_CSV},
               {.key = "device_ms", .precision = 3, .places = IN_CSV},
               {.key = "vertices_ms", .precision = 3, .places = IN_CSV},
               {.key = "build_ms", .precision = 3, .places = IN_CSV},
               {.key = "wide_ms", .precision = 3, .places = IN_CSV},
               {.key = "trace_ms", .precision = 3, .places = IN_CSV},
               {.key = "rebuilt", .places = IN_CSV},
               {.key = "sah", .precision = 4, .places = IN_CSV},
               {.key = "active", .places = IN_CSV},
               {.key = "hits", .places = IN_CSV},
               {.key = "steps", .places = IN_CSV},
               {.key = "image_hash", .places = IN_CSV, .quoted = false}});
  for (const AnimatedFrame& f : report.frames) {
    table.add({{std::uint64_t{f.number}, f.frame_ms, f.device_ms, f.vertices_ms, f.update_ms, f.wide_ms,
                f.trace_ms, std::uint64_t{f.rebuilt}, report.tree_cost ? Cell(f.sah) : Cell(),
                std::uint64_t{f.active_count}, f.hits, f.steps, hex16(f.hash)}});
  }
  return table.csv() + "\n";
}

std::string to_svg(const AnimateReport& report) {
  CurvePanel times{"ms", {}};
  for (const TimedPart& part : timed_parts) times.curves.push_back({part.name, curve_of(report, part.value)});
  const double first = report.frames.empty() ? 0 : report.frames.front().number;
  std::vector<CurvePanel> panels = {times};
  if (report.tree_cost)
    panels.push_back({"SAH cost", {{"of the tree", curve_of(report, &AnimatedFrame::sah)}}});
  return to_svg(report.scene + ", " + report.builder + " on " + report.device + ", --update " +
                    word_of_update(report.update),
                "frame", first, panels);
}

}  // namespace coppice
