#include "measure/effects_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "measure/table.h"

namespace coppice {

namespace {

std::string why(const EffectSet::State& state) {
  const std::string called =
      state.called_by.empty() ? "nothing calls for it" : "called for by " + state.called_by;
  if (!state.overridden) return called;
  return std::string(state.on ? "turned on" : "turned off") + " by --effects; " + called;
}

// A line's name and whether it is on, all of the same width.
std::string named(std::string_view name, const char* on) {
  std::size_t longest = 0;
  for (const std::string_view effect : EFFECT_NAMES) longest = std::max(longest, effect.size());
  return format("%-*s %-3s", static_cast<int>(longest), std::string(name).c_str(), on);
}

Json state_json(Effect effect, const EffectSet::State& state) {
  return {{"name", name_of(effect)},
          {"on", state.on},
          {"called_by", state.called_by.empty() ? Json(nullptr) : Json(state.called_by)},
          {"overridden", state.overridden}};
}

std::string listed(const std::vector<RecordedPicture::Kernel>& kernels) {
  std::string text;
  for (const RecordedPicture::Kernel& kernel : kernels) {
    text += (text.empty() ? "" : ", ") + kernel.name;
    if (kernel.dispatches > 1) text += format(" x %u", kernel.dispatches);
  }
  return text;
}

Json names(const std::vector<RecordedPicture::Kernel>& kernels) {
  Json list = Json::array();
  for (const RecordedPicture::Kernel& kernel : kernels) list.push_back(kernel.name);
  return list;
}

}  // namespace

std::uint32_t EffectCost::dispatches() const {
  if (!state.on || shares_kernels()) return own_steps;
  std::uint32_t sum = 0;
  for (const RecordedPicture::Kernel& kernel : kernels) sum += kernel.dispatches;
  return sum;
}

std::string explain(const EffectSet& effects) {
  std::string text;
  for (std::size_t i = 0; i < effect_count; ++i) {
    const EffectSet::State& state = effects.of(static_cast<Effect>(i));
    text += named(EFFECT_NAMES[i], state.on ? "on" : "off") + "  " + why(state) + "\n";
  }
  return text;
}

Json to_json(const EffectSet& effects) {
  Json json = Json::array();
  for (std::size_t i = 0; i < effect_count; ++i) {
    const Effect effect = static_cast<Effect>(i);
    json.push_back(state_json(effect, effects.of(effect)));
  }
  return json;
}

std::string text_of(const EffectsReport& report, const FrameRuns& frame) {
  std::string text =
      format("%s: %ux%u, %u spp, %llu rays of the camera, %.1f ms on %s\n\n", report.scene.c_str(),
             frame.trace.width, frame.trace.height, frame.trace.samples,
             static_cast<unsigned long long>(report.camera_rays), report.trace_ms, report.device.c_str());
  text += named("effect", "") +
          format(" %10s %12s %10s %10s  %s\n", "dispatches", "rays", "MB", "ms", "called for by");
  for (const EffectCost& cost : report.costs) {
    const std::string ms = cost.ms ? format("%.1f", *cost.ms) : "?";
    text += named(name_of(cost.effect), cost.state.on ? "on" : "off") +
            format(" %10u %12llu %10.2f %10s  %s\n", cost.dispatches(),
                   static_cast<unsigned long long>(cost.rays), static_cast<double>(cost.bytes) * 1e-6,
                   ms.c_str(), why(cost.state).c_str());
    if (cost.shares_kernels()) text += "           shares its kernels with other effects\n";
    if (!cost.kernels.empty()) text += "           adds " + listed(cost.kernels) + "\n";
    if (!cost.instead_of.empty()) text += "           in the place of " + listed(cost.instead_of) + "\n";
  }
  return text +
         "\nEach that is on by the picture with it and once more without it; ms of the kernels that "
         "differ, or of all where it shares its own.\n";
}

Json to_json(const EffectsReport& report, const FrameRuns& frame) {
  Json effects = Json::array();
  for (const EffectCost& cost : report.costs) {
    Json one = state_json(cost.effect, cost.state);
    one["kernels"] = names(cost.kernels);
    one["dispatches"] = cost.dispatches();
    one["shares_kernels"] = cost.shares_kernels();
    one["instead_of"] = names(cost.instead_of);
    one["rays"] = cost.rays;
    one["bytes"] = cost.bytes;
    one["ms"] = cost.ms ? Json(*cost.ms) : Json(nullptr);
    effects.push_back(std::move(one));
  }
  return {{"scene", report.scene},        {"device", report.device},      {"width", frame.trace.width},
          {"height", frame.trace.height}, {"spp", frame.trace.samples},   {"camera_rays", report.camera_rays},
          {"trace_ms", report.trace_ms},  {"effects", std::move(effects)}};
}

}  // namespace coppice
