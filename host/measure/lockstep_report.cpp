#include "measure/lockstep_report.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "measure/table.h"

namespace coppice {

namespace {

using Count = unsigned long long;

Json to_json(const std::optional<Difference>& difference) {
  if (!difference) return nullptr;
  return {{"stage", difference->stage}, {"slot", difference->slot}, {"index", difference->index},
          {"cpu", difference->cpu},     {"gpu", difference->gpu},   {"why", difference->why}};
}

std::string line_of(const NearlyListing& one) {
  const NearlyEqual& sum = one.sum;
  std::string line =
      format("%s, %s: %llu of %llu differ, %llu by more than the tolerance (%llu may)", one.stage, one.slot,
             static_cast<Count>(sum.differing), static_cast<Count>(sum.count), static_cast<Count>(sum.beyond),
             static_cast<Count>(sum.beyond_allowed));
  if (sum.tied)
    line += format(", %llu in the triangle at the same distance (%llu may)", static_cast<Count>(sum.tied),
                   static_cast<Count>(sum.tied_allowed));
  return line + "\n";
}

void add_nearly(Json& json, std::span<const NearlyListing> listings) {
  if (listings.empty()) return;
  NearlyEqual hits;
  json["nearly"] = Json::array();
  for (const NearlyListing& one : listings) {
    json["nearly"].push_back({{"stage", one.stage},
                              {"slot", one.slot},
                              {"compared", one.sum.count},
                              {"differing", one.sum.differing},
                              {"beyond", one.sum.beyond},
                              {"beyond_allowed", one.sum.beyond_allowed}});
    if (one.slot == std::string_view("hits")) hits = one.sum;
  }
  json["hits_differing"] = hits.differing;
  json["hits_on_other_triangle"] = hits.tied;
  json["largest_relative_t"] = hits.largest_relative_t;
}

}  // namespace

LockstepReport lockstep_report(const LockstepExecutor& executor, std::optional<Difference> difference,
                               const FramePlan& plan) {
  return {plan.tree.triangle_count, plan.build->rounds_bound,
          executor.stages_run(),    executor.cpu().read(plan.tree.state)[0],
          std::move(difference),    executor.nearly()};
}

Json to_json(const LockstepReport& report) {
  Json json = {{"stages", report.stages_run},
               {"equal", !report.difference},
               {"first_difference", to_json(report.difference)}};
  add_nearly(json, report.nearly);
  return json;
}

std::string text_of(const LockstepReport& report, const std::string& scene, const std::string& device) {
  std::string text = format(
      "%s: %u triangles, %u rounds of at most %u, %u stages run on %s and by their twins\n", scene.c_str(),
      report.triangles, report.state.round_count, report.rounds_bound, report.stages_run, device.c_str());
  for (const NearlyListing& one : report.nearly) text += line_of(one);
  if (!report.difference) return text + "no difference\n";
  const Difference& first = *report.difference;
  text += format("first difference: stage %s, slot %s, index %llu\n  cpu %s\n  gpu %s\n", first.stage.c_str(),
                 first.slot.c_str(), static_cast<Count>(first.index), first.cpu.c_str(), first.gpu.c_str());
  return text + (first.why.empty() ? "" : "  " + first.why + "\n");
}

}  // namespace coppice
