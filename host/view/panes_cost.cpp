#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "measure/table.h"
#include "view/pane_style.h"
#include "view/viewer.h"

namespace coppice {

namespace {

ImU32 colour_of_group(std::size_t index) {
  constexpr ImU32 colours[] = {IM_COL32(78, 121, 167, 255),  IM_COL32(242, 142, 43, 255),
                               IM_COL32(89, 161, 79, 255),   IM_COL32(225, 87, 89, 255),
                               IM_COL32(118, 183, 178, 255), IM_COL32(237, 201, 72, 255),
                               IM_COL32(176, 122, 161, 255), IM_COL32(255, 157, 167, 255),
                               IM_COL32(156, 117, 95, 255),  IM_COL32(186, 176, 172, 255)};
  return colours[index % std::size(colours)];
}

}  // namespace

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
  if (const ViewedFrame& frame = statistics_.last; frame.samples > 1)
    ImGui::Text("%u of %u samples, error %.4f", frame.samples, run_.refine.most_samples, frame.error);
  const TraceCounts& counts = statistics_.last.counts;
  if (counts.rays != 0)
    ImGui::Text("%.1f steps a ray, %.0f %% hit",
                static_cast<double>(counts.steps) / static_cast<double>(counts.rays),
                100.0 * static_cast<double>(counts.hits) / static_cast<double>(counts.rays));
  const auto secondary = [](const char* kind, const TraceCounts& traced, const char* hit = "blocked") {
    if (traced.rays != 0)
      ImGui::Text("%.2f M %s rays, %.0f %% %s", static_cast<double>(traced.rays) * 1e-6, kind,
                  100.0 * static_cast<double>(traced.hits) / static_cast<double>(traced.rays), hit);
  };
  secondary("shadow", statistics_.last.shadow);
  secondary("occlusion", statistics_.last.occlusion);
  secondary("bounced", statistics_.last.bounced, "hit");
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

}  // namespace coppice
