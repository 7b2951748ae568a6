#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/progress.h"
#include "apps/report.h"
#include "apps/stability.h"
#include "scene/input_error.h"

namespace coppice {

namespace {

using Count = unsigned long long;

std::string name_of(const IntersectionVariant& variant) {
  return std::string(variant.triangle) + " + " + std::string(variant.box);
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

Json to_json(const LeakCount& leak) {
  return {{"mesh", leak.mesh},
          {"scale", leak.scale},
          {"triangle_test", leak.variant->triangle},
          {"box_test", leak.variant->box},
          {"rays", leak.rays},
          {"leaks", leak.leaks},
          {"example", leak.example},
          {"seconds", leak.seconds}};
}

void print_header() {
  std::printf("%-25s %9s %9s %5s %-5s %-4s  %-19s %6s %6s %6s %6s %6s %9s %9s %-4s\n", "case", "triangles",
              "rounds", "depth", "valid", "bits", "triangle + box", "rays", "missed", "edges", "leaks",
              "false", "t ulp", "uv ulp", "bits");
}

// What makes the case fail: rays of the accurate tests, and bits of all of them.
void print_failures(const StabilityCase& result) {
  for (const VariantResult& variant : result.variants) {
    const bool is_accurate = &variant == &result.variants.back();
    for (const RayResult& kind : variant.kinds) {
      for (const RayExample& example : kind.examples) {
        const bool fails =
            example.failure == OTHER_BITS || (is_accurate && example.failure != MISSED_AT_EDGE);
        if (!fails) continue;
        std::printf("  seed %llu, %s, %s\n", static_cast<Count>(result.seed),
                    name_of(*variant.variant).c_str(), described(example).c_str());
      }
    }
  }
}

void print_case(const StabilityCase& result) {
  char rounds[32];
  std::snprintf(rounds, sizeof rounds, "%u/%u", result.rounds, result.rounds_bound);
  const bool bits = result.difference.empty() && result.same_as_builder;
  for (const VariantResult& variant : result.variants) {
    const RayResult total = variant.total();
    const HitVerdicts& verdicts = total.verdicts;
    const bool first = &variant == &result.variants.front();
    std::printf("%-25s ", first ? result.scene.c_str() : "");
    if (first) {
      std::printf("%9llu %9s %5u %-5s %-4s", static_cast<Count>(result.triangles), rounds, result.depth,
                  result.fault.empty() ? "yes" : "NO", bits ? "same" : "DIFF");
    } else {
      std::printf("%36s", "");
    }
    std::printf("  %-19s %6llu %6llu %6llu %6llu %6llu %9.3g %9.3g %-4s\n", name_of(*variant.variant).c_str(),
                static_cast<Count>(verdicts.rays), static_cast<Count>(verdicts.missed),
                static_cast<Count>(verdicts.missed_at_edges), static_cast<Count>(total.leaks),
                static_cast<Count>(verdicts.false_hits), verdicts.worst_t_ulps, verdicts.worst_uv_ulps,
                variant.bits_equal ? "same" : "DIFF");
    if (!variant.error.empty()) std::printf("  %s\n", variant.error.c_str());
  }
  print_failures(result);
  if (!result.fault.empty()) std::printf("  %s\n", result.fault.c_str());
  if (!result.difference.empty()) std::printf("  first difference: %s\n", result.difference.c_str());
  if (!result.same_as_builder) std::printf("  the tree is not that of the builder on the host\n");
}

// Sums over cases and seeds, by variant and kind of ray.
class KindSums {
 public:
  void add(const StabilityCase& one) {
    for (std::size_t v = 0; v < sums_.size(); ++v) {
      for (const RayResult& kind : one.variants[v].kinds) {
        auto sum = std::ranges::find(sums_[v], kind.kind, &RayResult::kind);
        if (sum == sums_[v].end()) sum = sums_[v].insert(sums_[v].end(), {kind.kind, {}});
        sum->verdicts += kind.verdicts;
        sum->leaks += kind.leaks;
      }
    }
  }

  void print() const {
    std::printf("\n%-19s %-17s %8s %8s %7s %7s %7s %7s\n", "triangle + box", "rays", "number", "hits",
                "missed", "edges", "leaks", "false");
    for (std::size_t v = 0; v < sums_.size(); ++v) {
      for (const RayResult& sum : sums_[v]) {
        std::printf("%-19s %-17s %8llu %8llu %7llu %7llu %7llu %7llu\n",
                    &sum == &sums_[v].front() ? name_of(intersection_variants()[v]).c_str() : "",
                    std::string(sum.kind).c_str(), static_cast<Count>(sum.verdicts.rays),
                    static_cast<Count>(sum.verdicts.hits), static_cast<Count>(sum.verdicts.missed),
                    static_cast<Count>(sum.verdicts.missed_at_edges), static_cast<Count>(sum.leaks),
                    static_cast<Count>(sum.verdicts.false_hits));
      }
    }
  }

 private:
  std::vector<std::vector<RayResult>> sums_ =
      std::vector<std::vector<RayResult>>(intersection_variants().size());
};

bool fails(const LeakCount& leak) {
  return leak.variant == &intersection_variants().back() && leak.leaks > 0;
}

void print_leaks(std::span<const LeakCount> leaks) {
  std::printf("\n%-12s %7s  %-19s %11s %9s %10s %8s\n", "closed mesh", "scale", "triangle + box", "rays",
              "leaks", "rate", "Mrays/s");
  for (const LeakCount& leak : leaks) {
    const auto rays = static_cast<double>(leak.rays);
    std::printf("%-12s %7g  %-19s %11llu %9llu %10.2g %8.2f\n", leak.mesh.c_str(), leak.scale,
                name_of(*leak.variant).c_str(), static_cast<Count>(leak.rays), static_cast<Count>(leak.leaks),
                static_cast<double>(leak.leaks) / rays, rays / leak.seconds / 1e6);
    if (fails(leak)) std::printf("  %s\n", leak.example.c_str());
  }
}

std::vector<const HardCase*> chosen_cases(const Options& options) {
  std::vector<const HardCase*> cases;
  for (std::string_view name : options.cases) {
    if (name.starts_with("hard:")) name.remove_prefix(5);
    cases.push_back(find_hard_case(name));
    if (!cases.back()) throw InputError("--cases: unknown hard case '" + std::string(name) + "'");
  }
  if (cases.empty()) {
    for (const HardCase& hard_case : hard_cases()) cases.push_back(&hard_case);
  }
  return cases;
}

struct ExaminedCases {
  std::vector<StabilityCase> rows;  // of more seeds than one only those that fail
  std::uint64_t examined = 0, failed = 0;
  KindSums kinds;
};

ExaminedCases examine_cases(CheckedDevice& device, std::span<const HardCase* const> chosen,
                            const Options& options, StabilityOptions stability) {
  ExaminedCases cases;
  Progress progress("hard cases", static_cast<std::uint32_t>(chosen.size()) * options.seed_count);
  for (std::uint32_t seed = 0; seed < options.seed_count; ++seed, ++stability.seed) {
    for (const HardCase* const hard_case : chosen) {
      const StabilityCase result = examine_case(device, *hard_case, options, stability);
      ++cases.examined;
      cases.failed += !result.passes();
      cases.kinds.add(result);
      if (options.seed_count == 1 || !result.passes()) cases.rows.push_back(result);
      progress.step();
    }
  }
  return cases;
}

}  // namespace

int run_stability(const Options& options) {
  const std::vector<const HardCase*> chosen = chosen_cases(options);
  CheckedDevice device = open_device(options, {});
  const StabilityOptions stability{options.most_triangles, options.rays_of_a_kind, options.seed};
  const ExaminedCases cases = examine_cases(device, chosen, options, stability);
  std::vector<LeakCount> leaks;
  if (options.leak_rays) leaks = count_leaks(device, chosen, options.leak_rays, options, stability);
  const double nan_cost = cost_of_nan_rays(device, options);

  const std::uint64_t failed = cases.failed + std::ranges::count_if(leaks, fails);
  if (talks(options)) {
    if (!cases.rows.empty()) print_header();
    for (const StabilityCase& one : cases.rows) print_case(one);
    cases.kinds.print();
    if (!leaks.empty()) print_leaks(leaks);
    std::printf("\nA ray with a NaN takes %.2f times as long as a random one.\n", nan_cost);
  }
  Json json = {{"device", device.properties().name},
               {"driver", device.properties().driver},
               {"examined", cases.examined},
               {"cases", Json::array()},
               {"leaks", Json::array()},
               {"nan_ray_cost", nan_cost},
               {"failed", failed}};
  for (const StabilityCase& one : cases.rows) json["cases"].push_back(to_json(one));
  for (const LeakCount& leak : leaks) json["leaks"].push_back(to_json(leak));
  write_json(options.json, json);
  const int validation = validation_status(device.device());
  if (failed) std::fprintf(stderr, "coppice: %llu rows are not stable\n", static_cast<Count>(failed));
  return failed ? 1 : validation;
}

}  // namespace coppice
