#include "measure/stability_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace coppice {

namespace {

std::string name_of(const IntersectionVariant& variant) {
  return std::string(variant.triangle) + " + " + std::string(variant.box);
}

Json to_json(const vec3& v) { return {v.x, v.y, v.z}; }

Json triangle_to_json(std::uint32_t triangle) { return triangle == NO_TRIANGLE ? Json() : Json(triangle); }

Json to_json(const RayExample& example) {
  const bool hits = example.hit.triangle != NO_TRIANGLE;
  const bool should_hit = example.expected.triangle != NO_TRIANGLE;
  return {{"failure", example.failure},
          {"kind", example.kind},
          {"ray", example.index},
          {"origin", to_json(example.ray.origin)},
          {"direction", to_json(example.ray.direction)},
          {"t_min", example.ray.t_min},
          {"t_max", example.ray.t_max},
          {"triangle", triangle_to_json(example.hit.triangle)},
          {"t", hits ? Json(example.hit.t) : Json()},
          {"u", hits ? Json(example.hit.u) : Json()},
          {"v", hits ? Json(example.hit.v) : Json()},
          {"expected_triangle", triangle_to_json(example.expected.triangle)},
          {"expected_t", should_hit ? Json(example.expected.meeting.t) : Json()},
          {"reason", example.reason}};
}

Json to_json(const RayResult& result) {
  const HitVerdicts& verdicts = result.verdicts;
  Json examples = Json::array();
  for (const RayExample& example : result.examples) examples.push_back(to_json(example));
  return {{"rays", verdicts.rays},
          {"hits", verdicts.hits},
          {"missed", verdicts.missed},
          {"missed_at_edges", verdicts.missed_at_edges},
          {"behind_edges", verdicts.behind_edges},
          {"leaks", result.leaks},
          {"false_hits", verdicts.false_hits},
          {"false_on_degenerate", verdicts.false_on_degenerate},
          {"other_triangle", verdicts.other_triangle},
          {"worst_t_ulps", verdicts.worst_t_ulps},
          {"worst_t_scaled", verdicts.worst_t_scaled},
          {"worst_uv_ulps", verdicts.worst_uv_ulps},
          {"example", result.example()},
          {"examples", std::move(examples)}};
}

Json to_json(const VariantResult& result) {
  Json json = {{"triangle_test", result.variant->triangle},
               {"box_test", result.variant->box},
               {"bits_equal", result.bits_equal},
               {"error", result.error}};
  json.update(to_json(result.total()));
  for (const RayResult& kind : result.kinds) json["kinds"][std::string(kind.kind)] = to_json(kind);
  return json;
}

}  // namespace

Json to_json(const StabilityCase& result) {
  Json json = {{"case", result.scene},
               {"seed", result.seed},
               {"triangles", result.triangles},
               {"rounds", result.rounds},
               {"rounds_bound", result.rounds_bound},
               {"depth", result.depth},
               {"valid", result.fault.empty()},
               {"fault", result.fault},
               {"bits_equal", result.difference.empty()},
               {"first_difference", result.difference},
               {"same_as_builder", result.same_as_builder},
               {"passes", result.passes()}};
  for (const VariantResult& variant : result.variants) json["variants"].push_back(to_json(variant));
  return json;
}

namespace {

// What makes the case fail: rays of the accurate tests, and bits of all of them.
void add_failures(std::vector<std::string>& lines, const StabilityCase& result) {
  for (const VariantResult& variant : result.variants) {
    const bool is_accurate = &variant == &result.variants.back();
    for (const RayResult& kind : variant.kinds) {
      for (const RayExample& example : kind.examples) {
        const bool fails =
            example.failure == OTHER_BITS || (is_accurate && example.failure != MISSED_AT_EDGE);
        if (fails)
          lines.push_back("  seed " + std::to_string(result.seed) + ", " + name_of(*variant.variant) + ", " +
                          described(example));
      }
    }
  }
}

std::vector<std::string> faults_of(const StabilityCase& result) {
  std::vector<std::string> lines;
  add_failures(lines, result);
  if (!result.fault.empty()) lines.push_back("  " + result.fault);
  if (!result.difference.empty()) lines.push_back("  first difference: " + result.difference);
  if (!result.same_as_builder) lines.push_back("  the tree is not that of the builder on the host");
  return lines;
}

const char* same(bool bits) { return bits ? "same" : "DIFF"; }

Column counted(std::string heading, int width) { return {.heading = std::move(heading), .width = width}; }

}  // namespace

Table table_of(std::span<const StabilityCase> cases) {
  Table table({{.heading = "case", .width = -25, .gap = 0},
               counted("triangles", 9),
               counted("rounds", 9),
               counted("depth", 5),
               counted("valid", -5),
               counted("bits", -4),
               {.heading = "triangle + box", .width = -19, .gap = 2},
               counted("rays", 6),
               counted("missed", 6),
               counted("edges", 6),
               counted("leaks", 6),
               counted("false", 6),
               {.heading = "t ulp", .width = 9, .precision = 3, .style = 'g'},
               {.heading = "uv ulp", .width = 9, .precision = 3, .style = 'g'},
               counted("bits", -4)});
  for (const StabilityCase& one : cases) {
    const bool bits = one.difference.empty() && one.same_as_builder;
    for (const VariantResult& variant : one.variants) {
      std::vector<Cell> cells(6);
      if (&variant == &one.variants.front())
        cells = {one.scene,
                 one.triangles,
                 std::to_string(one.rounds) + "/" + std::to_string(one.rounds_bound),
                 one.depth,
                 one.fault.empty() ? "yes" : "NO",
                 same(bits)};
      const RayResult total = variant.total();
      const HitVerdicts& verdicts = total.verdicts;
      cells.insert(cells.end(), {name_of(*variant.variant), verdicts.rays, verdicts.missed,
                                 verdicts.missed_at_edges, total.leaks, verdicts.false_hits,
                                 verdicts.worst_t_ulps, verdicts.worst_uv_ulps, same(variant.bits_equal)});
      Row row{std::move(cells)};
      if (!variant.error.empty()) row.below.push_back("  " + variant.error);
      if (&variant == &one.variants.back())
        for (std::string& line : faults_of(one)) row.below.push_back(std::move(line));
      table.add(std::move(row));
    }
  }
  return table;
}

Table table_of(const KindSums& kinds) {
  Table table({{.heading = "triangle + box", .width = -19, .gap = 0},
               counted("rays", -17),
               counted("number", 8),
               counted("hits", 8),
               counted("missed", 7),
               counted("edges", 7),
               counted("leaks", 7),
               counted("false", 7)});
  for (std::size_t v = 0; v < kinds.sums().size(); ++v) {
    for (const RayResult& sum : kinds.sums()[v]) {
      const bool first = &sum == &kinds.sums()[v].front();
      table.add(
          {{first ? name_of(intersection_variants()[v]) : "", sum.kind, sum.verdicts.rays, sum.verdicts.hits,
            sum.verdicts.missed, sum.verdicts.missed_at_edges, sum.leaks, sum.verdicts.false_hits}});
    }
  }
  return table;
}

Table table_of(std::span<const LeakCount> leaks) {
  Table table({{.key = "mesh", .heading = "closed mesh", .width = -12, .gap = 0},
               {.key = "scale", .heading = "scale", .width = 7, .precision = 6, .style = 'g'},
               {.key = "triangle_test", .places = IN_JSON},
               {.key = "box_test", .places = IN_JSON},
               {.heading = "triangle + box", .width = -19, .places = IN_TEXT, .gap = 2},
               {.key = "rays", .heading = "rays", .width = 11},
               {.key = "leaks", .heading = "leaks", .width = 9},
               {.heading = "rate", .width = 10, .precision = 2, .places = IN_TEXT, .style = 'g'},
               {.key = "example", .places = IN_JSON},
               {.key = "seconds", .places = IN_JSON},
               {.heading = "Mrays/s", .width = 8, .precision = 2, .places = IN_TEXT}});
  for (const LeakCount& leak : leaks) {
    const auto rays = static_cast<double>(leak.rays);
    Row row{{leak.mesh, leak.scale, leak.variant->triangle, leak.variant->box, name_of(*leak.variant),
             leak.rays, leak.leaks, static_cast<double>(leak.leaks) / rays, leak.example, leak.seconds,
             rays / leak.seconds / 1e6}};
    if (leak.fails()) row.below.push_back("  " + leak.example);
    table.add(std::move(row));
  }
  return table;
}

}  // namespace coppice
