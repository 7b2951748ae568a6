#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "builders/registry.h"
#include "measure/table.h"
#include "render/box_lines.h"
#include "scene/motion.h"
#include "view/viewer.h"

namespace coppice {

namespace {

constexpr float pane_width = 312, margin = 10;
constexpr const char* help_text[][2] = {
    {"drag", "turn around what is looked at; flying: look around"},
    {"shift or right drag", "move sideways"},
    {"wheel", "nearer, farther; flying: forward, backward"},
    {"W A S D, E Q", "fly forward, left, backward, right, up, down; shift: faster"},
    {"F", "fly or orbit"},
    {"R", "the camera of the beginning"},
    {"B", "build the tree anew once"},
    {"1 to 8", "color, steps, normals, depth, ids, morton, clusters, boxes"},
    {"space", "play or pause"},
    {". ,", "a step forward, back"},
    {"P", "write the picture as PNG"},
    {"C", "copy the arguments that render this picture"},
    {"tab", "show or hide the panes"},
    {"?  F1", "this help"},
    {"escape", "close"}};

ImU32 colour_of_group(std::size_t index) {
  constexpr ImU32 colours[] = {IM_COL32(78, 121, 167, 255),  IM_COL32(242, 142, 43, 255),
                               IM_COL32(89, 161, 79, 255),   IM_COL32(225, 87, 89, 255),
                               IM_COL32(118, 183, 178, 255), IM_COL32(237, 201, 72, 255),
                               IM_COL32(176, 122, 161, 255), IM_COL32(255, 157, 167, 255),
                               IM_COL32(156, 117, 95, 255),  IM_COL32(186, 176, 172, 255)};
  return colours[index % std::size(colours)];
}

ImU32 colour_of(const std::array<std::uint8_t, 3>& code, int alpha = 255) {
  return IM_COL32(code[0], code[1], code[2], alpha);
}

constexpr ImGuiWindowFlags fixed_pane = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoFocusOnAppearing |
                                        ImGuiWindowFlags_NoNav;

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
  // Dear ImGui does not see a key that goes down and up between two frames.
  bool entered = ImGui::InputText("scene", &typed_scene_,
                                  ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  if (ImGui::IsItemActive() && request_.enter) {
    entered = true;
    ImGui::ClearActiveID();
  }
  request_.enter = false;
  if (entered && !typed_scene_.empty()) asked_.scene.spec = typed_scene_;
  if (ImGui::BeginCombo("built in", "choose", ImGuiComboFlags_HeightLarge)) {
    for (const SceneListing& listing : list_scenes()) {
      if (ImGui::Selectable(listing.name.c_str())) asked_.scene.spec = typed_scene_ = listing.name;
    }
    ImGui::EndCombo();
  }
  if (opened_) {
    ImGui::TextDisabled("%u triangles%s", opened_->arrays.triangle_count(),
                        opened_->scene.motion ? ", moving" : "");
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
  if (!opened_ || !opened_->scene.motion) return;
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

std::string Viewer::size_text(std::uint64_t bytes) const {
  return format("%.1f MB", static_cast<double>(bytes) * 1e-6);
}

void Viewer::cost_pane() {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x - pane_width - margin, margin});
  ImGui::SetNextWindowSize({pane_width, 0});
  ImGui::Begin("cost", nullptr, fixed_pane);
  if (!frames_ || statistics_.frames.empty()) {
    ImGui::TextDisabled("no frame yet");
    ImGui::End();
    return;
  }
  const ViewStatistics::Frame& last = statistics_.frames.back();
  ImGui::Text("%.1f ms a frame, %.1f on the device", last.frame_ms, last.device_ms);
  ImGui::TextDisabled("%ux%u, %s", width_, height_, device_->properties().name.substr(0, 24).c_str());
  kernel_chart();
  ImGui::Separator();
  const TraceCounts& counts = statistics_.last.counts;
  if (counts.rays != 0)
    ImGui::Text("%.1f steps a ray, %.0f %% hit",
                static_cast<double>(counts.steps) / static_cast<double>(counts.rays),
                100.0 * static_cast<double>(counts.hits) / static_cast<double>(counts.rays));
  tree_controls();
  if (ImGui::CollapsingHeader("memory")) {
    ImGui::Text("%s on the device", size_text(frames_->device_bytes()).c_str());
    std::vector<const SlotListing*> largest;
    for (const SlotListing& slot : frames_->slots()) largest.push_back(&slot);
    std::ranges::sort(largest, std::greater(), &SlotListing::bytes);
    largest.resize(std::min<std::size_t>(largest.size(), 8));
    for (const SlotListing* const slot : largest)
      ImGui::TextDisabled("%10s  %s", size_text(slot->bytes()).c_str(), slot->name.c_str());
  }
  ImGui::End();
}

// A column a frame, the groups of kernels one upon the other.
void Viewer::kernel_chart() {
  double most = 1;
  for (const auto& frame : statistics_.frames) most = std::max(most, frame.device_ms);
  const float width = ImGui::GetContentRegionAvail().x, height = 110;
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled(origin, {origin.x + width, origin.y + height}, IM_COL32(255, 255, 255, 14), 3);
  const float column = width / static_cast<float>(ViewStatistics::kept);
  float x = origin.x + width - column * static_cast<float>(statistics_.frames.size());
  for (const auto& frame : statistics_.frames) {
    float y = origin.y + height;
    const auto bar = [&](double ms, ImU32 colour) {
      const float top = y - static_cast<float>(ms / most) * height;
      draw->AddRectFilled({x, top}, {x + std::max(column, 1.0f), y}, colour);
      y = top;
    };
    if (frame.groups.empty()) bar(frame.device_ms, colour_of_group(0));
    for (std::size_t group = 0; group < statistics_.groups.size(); ++group) {
      const auto its = std::ranges::find(frame.groups, statistics_.groups[group], &KernelGroup::name);
      if (its != frame.groups.end()) bar(its->ms, colour_of_group(group));
    }
    x += column;
  }
  draw->AddText({origin.x + 4, origin.y + 2}, IM_COL32(200, 200, 200, 255), format("%.1f ms", most).c_str());
  ImGui::Dummy({width, height});
  if (!ImGui::BeginTable("groups", 2)) return;
  for (std::size_t group = 0; group < statistics_.groups.size(); ++group) {
    const auto& groups = statistics_.frames.back().groups;
    const auto its = std::ranges::find(groups, statistics_.groups[group], &KernelGroup::name);
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 3}, {at.x + 10, at.y + 13},
                                              colour_of_group(group), 2);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 16);
    if (its == groups.end())
      ImGui::TextDisabled("%s", statistics_.groups[group].c_str());
    else
      ImGui::Text("%s %.2f", statistics_.groups[group].c_str(), its->ms);
  }
  ImGui::EndTable();
}

void Viewer::tree_controls() {
  if (!statistics_.has_tree) return;
  const ViewedTree& tree = statistics_.tree;
  if (!ImGui::CollapsingHeader("tree", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::Text("SAH cost %.2f, depth %u", tree.sah, tree.depth);
  if (statistics_.last.refitted) ImGui::TextDisabled("refitted; B builds it anew");
  ImGui::TextDisabled("%llu nodes, %llu leaves", static_cast<unsigned long long>(tree.nodes),
                      static_cast<unsigned long long>(tree.leaves));
  if (!opened_->builder.on_device()) ImGui::TextDisabled("built on the host in %.1f ms", opened_->build_ms);
  if (tree.clusters.size() < 2) return;
  std::vector<float> logs;
  for (const std::uint32_t clusters : tree.clusters) logs.push_back(std::log2(static_cast<float>(clusters)));
  ImGui::TextDisabled("%zu rounds of PLOC, log2 of clusters", tree.clusters.size() - 1);
  ImGui::PlotHistogram("##rounds", logs.data(), static_cast<int>(logs.size()), 0, nullptr, 0, logs[0],
                       {ImGui::GetContentRegionAvail().x, 56});
}

// What the colours mean, with the map's ends.
void Viewer::legend() {
  if (!frames_ || map_name(asked_.show.show).empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y - margin}, ImGuiCond_Always, {0.5f, 1});
  ImGui::Begin("legend", nullptr, fixed_pane | ImGuiWindowFlags_NoInputs);
  const Show show = asked_.show.show;
  const ShowSpan span = frames_->span(film_);
  const float width = 320, height = 14;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  for (int i = 0; i < 64; ++i) {
    const double place = i / 63.0;
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x + width * static_cast<float>(i) / 64, at.y},
        {at.x + width * static_cast<float>(i + 1) / 64, at.y + height},
        colour_of(show == Show::depth ? viridis_code(1 - place) : turbo_code(place)));
  }
  ImGui::Dummy({width, height});
  if (show == Show::steps || show == Show::depth) {
    ImGui::Text("%s %.4g to %.4g; seen %.4g to %.4g", show == Show::steps ? "steps" : "depth",
                static_cast<double>(span.least), static_cast<double>(span.greatest),
                static_cast<double>(statistics_.last.seen.least),
                static_cast<double>(statistics_.last.seen.greatest));
  } else {
    ImGui::Text("%s",
                show == Show::morton ? "first to last along the Morton curve" : "root to the deepest level");
  }
  ImGui::End();
}

void Viewer::box_overlay() {
  if (asked_.show.show != Show::boxes || !frames_ || boxes_.empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float across = display.x / static_cast<float>(width_), down = display.y / static_cast<float>(height_);
  ImDrawList* const draw = ImGui::GetBackgroundDrawList();
  draw->AddRectFilled({0, 0}, display, IM_COL32(0, 0, 0, 128));
  for (const BoxLine& line : box_lines(boxes_, film_, asked_.show.level, 1u << 11))
    draw->AddLine({line.x[0] * across, line.y[0] * down}, {line.x[1] * across, line.y[1] * down},
                  colour_of(colour_of_level(line.level, asked_.show.level)));
}

void Viewer::messages() {
  std::string text = !device_              ? "checking the device"
                     : job_.is_under_way() ? job_.what() + " ..."
                                           : complaint_;
  if (text.empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x * 0.6f, display.y});
  ImGui::Begin("message", nullptr, fixed_pane);
  const bool is_complaint = device_ && !job_.is_under_way();
  ImGui::PushTextWrapPos(display.x * 0.55f);
  if (is_complaint)
    ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%s", text.c_str());
  else
    ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  if (is_complaint && ImGui::Button("close")) complaint_.clear();
  ImGui::End();
}

void Viewer::help_window() {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowFocus();
  ImGui::Begin("help", nullptr, fixed_pane);
  ImGui::TextUnformatted("Drop an OBJ file or another scene onto the window to see it.");
  ImGui::Separator();
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& [keys, what] : help_text) {
      ImGui::TableNextColumn();
      ImGui::TextColored({0.6f, 0.8f, 1, 1}, "%s", keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace coppice
