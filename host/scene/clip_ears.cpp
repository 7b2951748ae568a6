#include "scene/clip_ears.h"

#include <cstdint>
#include <glm/common.hpp>
#include <optional>

#include "scene/orientation.h"

namespace coppice {
namespace {

constexpr std::size_t TESTS_A_CORNER = 1024;  // at most; outlines of up to so many corners need fewer mostly

class EarClipper {
 public:
  EarClipper(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles)
      : outline_(outline), triangles_(triangles), left_(static_cast<std::uint32_t>(outline.size())) {
    for (std::uint32_t i = 0; i < left_; ++i) {
      next_.push_back(i + 1 < left_ ? i + 1 : 0);
      previous_.push_back(i > 0 ? i - 1 : left_ - 1);
    }
  }

  bool clip() {
    const std::size_t most_tests = TESTS_A_CORNER * outline_.size();
    std::uint32_t tip = 0;  // going round, instead of always from the first corner, makes rounder triangles
    while (left_ > 3) {
      if (tests_ < most_tests) tip = find_tip(tip);
      tip = cut_off(tip);
    }
    cut_off(tip);
    return !turned_over_;
  }

 private:
  int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return orientation(outline_[a], outline_[b], outline_[c]);
  }
  int turn_at(std::uint32_t tip) const { return turn(previous_[tip], tip, next_[tip]); }

  // The next ear; where there is none the next corner without area, to lose which changes nothing; else the
  // next that turns left, else any.
  std::uint32_t find_tip(std::uint32_t start) {
    std::optional<std::uint32_t> flat, left;
    std::uint32_t i = start;
    do {
      const int side = turn_at(i);
      if (side > 0 && is_empty(i)) return i;
      if (side == 0 && !flat) flat = i;
      if (side > 0 && !left) left = i;
      i = next_[i];
    } while (i != start);
    return flat ? *flat : left.value_or(start);
  }

  // Whether no other corner lies in the triangle at `tip`, but on its corners.
  bool is_empty(std::uint32_t tip) {
    const std::uint32_t a = previous_[tip], b = tip, c = next_[tip];
    const glm::vec2 low = glm::min(glm::min(outline_[a], outline_[b]), outline_[c]);
    const glm::vec2 high = glm::max(glm::max(outline_[a], outline_[b]), outline_[c]);
    for (std::uint32_t i = next_[c]; i != a; i = next_[i]) {
      ++tests_;
      const glm::vec2 p = outline_[i];
      if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) continue;
      if (p == outline_[a] || p == outline_[b] || p == outline_[c]) continue;
      if (turn(a, b, i) >= 0 && turn(b, c, i) >= 0 && turn(c, a, i) >= 0) return false;
    }
    return true;
  }

  // The corner after the one that is cut off.
  std::uint32_t cut_off(std::uint32_t tip) {
    const std::uint32_t a = previous_[tip], c = next_[tip];
    triangles_.emplace_back(a, tip, c);
    turned_over_ = turned_over_ || turn(a, tip, c) < 0;
    next_[a] = c;
    previous_[c] = a;
    --left_;
    return c;
  }

  std::span<const glm::vec2> outline_;
  std::vector<glm::uvec3>& triangles_;
  std::vector<std::uint32_t> next_, previous_;
  std::uint32_t left_;  // corners that are not cut off
  std::size_t tests_ = 0;
  bool turned_over_ = false;
};

}  // namespace

bool clip_ears(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles) {
  return EarClipper(outline, triangles).clip();
}

}  // namespace coppice
