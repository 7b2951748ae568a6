#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "builders/registry.h"
#include "measure/table.h"
#include "scene/motion.h"
#include "view/pane_style.h"
#include "view/viewer.h"

namespace coppice {

namespace {

// A choice among names; whether it was changed.
bool choose(const char* label, std::string& chosen, const std::vector<std::string>& names) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, chosen.c_str())) return false;
  for (const std::string& name : names) {
    if (!ImGui::Selectable(name.c_str(), name == chosen)) continue;
    changed = name != chosen;
    chosen = name;
  }
  ImGui::EndCombo();
  return changed;
}

WalkChoice walk_choice_of(const std::string& name) {
  WalkChoice walk;
  walk.said = "--tree " + name;
  walk.any_wide = name == "wide";
  for (const Walk one : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    if (name == name_of(one)) walk.walk = one;
  }
  return walk;
}

std::string name_of_walk(const WalkChoice& walk) {
  if (walk.walk) return std::string(name_of(*walk.walk));
  return walk.any_wide ? "wide" : "auto";
}

std::vector<std::string> all_builders() {
  std::vector<std::string> names;
  for (const NamedDeviceBuilder& named : device_builders()) names.emplace_back(named.name);
  for (const CpuBuilder& builder : cpu_builders()) names.emplace_back(builder.name);
  return names;
}

// A slider of whole numbers.
bool slide(const char* label, std::uint32_t& value, int least, int greatest) {
  int number = static_cast<int>(value);
  if (!ImGui::SliderInt(label, &number, least, greatest)) return false;
  value = static_cast<std::uint32_t>(std::clamp(number, least, greatest));
  return true;
}

}  // namespace

void Viewer::panes() {
  box_overlay();
  messages();
  legend();
  if (help_) help_window();
  if (!panes_) return;
  scene_pane();
  cost_pane();
}

void Viewer::scene_pane() {
  ImGui::SetNextWindowPos({margin, margin});
  ImGui::SetNextWindowSize({pane_width, 0});
  ImGui::Begin("scene", nullptr, fixed_pane);
  ImGui::PushItemWidth(190);
  const bool entered = ImGui::InputText(
      "scene", &typed_scene_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  if (entered && !typed_scene_.empty()) asked_.scene.spec = typed_scene_;
  if (ImGui::BeginCombo("built in", "choose", ImGuiComboFlags_HeightLarge)) {
    for (const SceneListing& listing : list_scenes()) {
      if (ImGui::Selectable(listing.name.c_str())) asked_.scene.spec = typed_scene_ = listing.name;
    }
    ImGui::EndCombo();
  }
  if (opened_) {
    ImGui::TextDisabled("%u triangles%s", opened_->arrays.triangle_count(),
                        cycle_of(opened_->scene) ? ", moving" : "");
    if (!opened_->scene.instances.empty())
      ImGui::TextDisabled("in %zu instances of meshes", opened_->scene.instances.size());
  }
  ImGui::Separator();
  choose("builder", asked_.builder.name, all_builders());
  slide("radius", asked_.builder.radius, 1, 100);
  std::string walk = name_of_walk(asked_.walk);
  if (choose("tracer", walk, {"auto", "binary", "wide", "wide-packets", "wide-single"}))
    asked_.walk = walk_choice_of(walk);
  static const std::vector<std::string> updates = {"rebuild what moved", "refit what moved",
                                                   "what costs less", "rebuild every frame"};
  std::string update = updates[asked_.rebuild ? 3 : static_cast<std::size_t>(asked_.update)];
  if (choose("update", update, updates)) {
    const auto chosen = std::ranges::find(updates, update) - updates.begin();
    asked_.rebuild = chosen == 3;
    asked_.update = chosen == 3 ? Update::rebuild : static_cast<Update>(chosen);
  }
  std::string part = format("1/%u", asked_.divide);
  if (choose("pixels", part, {"1/1", "1/2", "1/4"}))
    asked_.divide = static_cast<std::uint32_t>(part.back() - '0');
  ImGui::Checkbox("draw without a pause", &asked_.draws_always);
  ImGui::Separator();
  view_controls();
  time_controls();
  ImGui::PopItemWidth();
  ImGui::TextDisabled("%s - ? for help", flies_ ? "flying" : "orbit");
  ImGui::End();
}

void Viewer::view_controls() {
  std::string view(name_of(asked_.show.show));
  if (choose("view", view, {std::begin(SHOW_NAMES), std::end(SHOW_NAMES)}))
    asked_.show.show = static_cast<Show>(std::ranges::find(SHOW_NAMES, view) - SHOW_NAMES);
  if (asked_.show.show == Show::steps) {
    std::uint32_t most = asked_.show.most_steps ? asked_.show.most_steps
                                                : steps_shown(frames_ ? frames_->walk() : Walk::binary);
    if (slide("red at", most, 8, 512)) asked_.show.most_steps = most;
  }
  if (asked_.show.show == Show::clusters) {
    const auto rounds = static_cast<int>(statistics_.tree.clusters.size());
    if (rounds > 1)
      slide("round", asked_.show.round, 0, rounds - 1);
    else
      ImGui::TextDisabled("only gpu-ploc has rounds");
    const std::uint32_t round = asked_.show.round;
    if (round < statistics_.tree.clusters.size())
      ImGui::TextDisabled("%u clusters", statistics_.tree.clusters[round]);
  }
  if (asked_.show.show == Show::boxes) slide("levels", asked_.show.level, 0, 16);
}

void Viewer::time_controls() {
  if (!opened_ || !cycle_of(opened_->scene)) return;
  ImGui::Separator();
  if (frames_ && !frames_->can_move()) {
    ImGui::TextDisabled("it moves with builders gpu-...");
    return;
  }
  if (ImGui::Button(plays_ ? "pause" : "play")) plays_ = !plays_;
  for (const int direction : {-1, 1}) {
    ImGui::SameLine();
    if (!ImGui::Button(direction < 0 ? "<" : ">")) continue;
    plays_ = false;
    seconds_ = std::max(seconds_ + direction / frames_per_second(), 0.0);
  }
  const auto duration = static_cast<float>(scene_duration());
  auto at = static_cast<float>(std::fmod(seconds_, scene_duration()));
  if (ImGui::SliderFloat("time", &at, 0, duration, "%.2f s")) {
    plays_ = false;
    seconds_ = at;
  }
}

}  // namespace coppice
