#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>

namespace coppice {

// What all panes have in common.
inline constexpr float pane_width = 312, margin = 10;

inline constexpr ImGuiWindowFlags fixed_pane = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                               ImGuiWindowFlags_AlwaysAutoResize |
                                               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
                                               ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

inline ImU32 colour_of(const std::array<std::uint8_t, 3>& code, int alpha = 255) {
  return IM_COL32(code[0], code[1], code[2], alpha);
}

}  // namespace coppice
