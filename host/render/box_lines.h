#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interface/trace.h"

namespace coppice {

// An edge of a box as a film sees it, in pixels: (0, 0) is the picture's upper left corner.
struct BoxLine {
  float x[2], y[2];
  std::uint32_t level;  // of the box: 0 is the root's
};

// The edges of the boxes of all nodes down to a level, those of higher levels first. What is behind the eye
// is cut off. At most `limit` boxes, whole levels only but for the root's.
std::vector<BoxLine> box_lines(std::span<const Node> nodes, const Film& film, std::uint32_t level,
                               std::uint32_t limit);

inline constexpr std::uint32_t BOXES_SHOWN = 1u << 14;

// Colour of a level where `last` is the last one: turbo, a bit inside of its dark ends. RGB codes.
std::array<std::uint8_t, 3> colour_of_level(std::uint32_t level, std::uint32_t last);

// Draws them into a picture (RGBA8, rows top to bottom), which is darkened.
void draw_box_lines(std::span<uint> image, std::uint32_t width, std::uint32_t height,
                    std::span<const BoxLine> lines, std::uint32_t last_level);

}  // namespace coppice
