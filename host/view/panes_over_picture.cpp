#include <imgui.h>

#include "measure/table.h"
#include "render/box_lines.h"
#include "view/pane_style.h"
#include "view/viewer.h"

namespace coppice {

namespace {

constexpr const char* help_text[][2] = {
    {"drag", "turn around what is looked at; flying: look around"},
    {"shift or right drag", "move sideways"},
    {"wheel", "nearer, farther; flying: forward, backward"},
    {"W A S D, E Q", "fly forward, left, backward, right, up, down; shift: faster"},
    {"F", "fly or orbit"},
    {"R", "the camera of the beginning"},
    {"B", "build the tree anew once"},
    {"1 to 9", "color, steps, normals, depth, ids, morton, clusters, boxes, instances"},
    {"space", "play or pause"},
    {". ,", "a step forward, back"},
    {"P", "write the picture as PNG"},
    {"C", "copy the arguments that render this picture"},
    {"tab", "show or hide the panes"},
    {"?  F1", "this help"},
    {"escape", "close"}};

}  // namespace

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
