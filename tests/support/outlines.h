#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <glm/vec2.hpp>
#include <vector>

#include "scene/random.h"

namespace coppice {

// Closed outlines on whole numbers, so that their areas are exact. All wind to the left.
using Outline = std::vector<glm::ivec2>;

inline std::int64_t cross(glm::ivec2 a, glm::ivec2 b) {
  return std::int64_t{a.x} * b.y - std::int64_t{a.y} * b.x;
}

// Twice the area, positive where it winds to the left: the sum over the edges, of no triangle.
inline std::int64_t twice_area(const Outline& outline) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += cross(outline[i], outline[(i + 1) % outline.size()]);
  return sum;
}

// Corners all around the origin, which sees all of them: about as many as said, for some hide others.
inline Outline star_outline(Random& random, std::uint32_t corners) {
  Outline outline = {{1000, 0}, {-500, 870}, {-500, -870}};
  for (std::uint32_t i = 3; i < corners; ++i) {
    const int x = static_cast<int>(random.below(2001)) - 1000,
              y = static_cast<int>(random.below(2001)) - 1000;
    if (x != 0 || y != 0) outline.emplace_back(x, y);
  }
  const auto lower = [](glm::ivec2 p) { return p.y < 0 || (p.y == 0 && p.x < 0); };
  const auto before = [&](glm::ivec2 a, glm::ivec2 b) {
    return lower(a) != lower(b) ? lower(b) : cross(a, b) > 0;
  };
  std::ranges::stable_sort(outline, before);
  // Not of std::ranges: clang 14 does not take the subrange that it returns.
  const auto same = [&](glm::ivec2 a, glm::ivec2 b) { return !before(a, b) && !before(b, a); };
  outline.erase(std::unique(outline.begin(), outline.end(), same), outline.end());
  return outline;
}

// The border of squares of a grid that hang together by their sides, without holes. Where two of them touch
// at a corner only, that corner stands twice; corners within straight sides are kept.
inline Outline blocks_outline(Random& random, std::uint32_t most_blocks) {
  constexpr int side = 10;
  bool full[side][side] = {};
  const auto is_full = [&](int x, int y) { return x >= 0 && y >= 0 && x < side && y < side && full[x][y]; };
  const glm::ivec2 steps[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::vector<glm::ivec2> blocks = {{side / 2, side / 2}};
  full[side / 2][side / 2] = true;
  for (std::uint32_t i = random.below(most_blocks); i > 0; --i) {
    const glm::ivec2 from = blocks[random.below(static_cast<std::uint32_t>(blocks.size()))];
    const glm::ivec2 to = from + steps[random.below(4)];
    if (to.x < 1 || to.y < 1 || to.x > side - 2 || to.y > side - 2 || full[to.x][to.y]) continue;
    full[to.x][to.y] = true;
    blocks.push_back(to);
  }
  // What cannot be reached from outside, diagonals included, is filled.
  bool outside[side][side] = {};
  std::vector<glm::ivec2> reached = {{0, 0}};
  outside[0][0] = true;
  while (!reached.empty()) {
    const glm::ivec2 at = reached.back();
    reached.pop_back();
    for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, side - 1); ++x) {
      for (int y = std::max(at.y - 1, 0); y <= std::min(at.y + 1, side - 1); ++y) {
        if (full[x][y] || outside[x][y]) continue;
        outside[x][y] = true;
        reached.emplace_back(x, y);
      }
    }
  }
  int first_x = 0, first_y = 0;
  for (int x = side - 1; x >= 0; --x) {
    for (int y = side - 1; y >= 0; --y) {
      full[x][y] = !outside[x][y];
      if (full[x][y]) first_x = x, first_y = y;
    }
  }
  // Along the border with the squares to the left, at each corner as far to the left as it goes.
  const auto is_border = [&](glm::ivec2 at, int direction) {
    const glm::ivec2 left[] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}},
                     right[] = {{0, -1}, {0, 0}, {-1, 0}, {-1, -1}};
    const glm::ivec2 l = at + left[direction], r = at + right[direction];
    return is_full(l.x, l.y) && !is_full(r.x, r.y);
  };
  const glm::ivec2 start{first_x, first_y};
  Outline outline;
  glm::ivec2 at = start;
  int direction = 0;
  do {
    outline.push_back(at);
    at += steps[direction];
    for (int turn : {1, 0, 3}) {
      if (!is_border(at, (direction + turn) % 4)) continue;
      direction = (direction + turn) % 4;
      break;
    }
  } while (at != start || direction != 0);
  return outline;
}

// A long rectangle with rectangular holes side by side, each bound to the lower side by an edge there and
// back.
inline Outline holes_outline(Random& random, std::uint32_t holes) {
  const int count = static_cast<int>(holes);
  Outline outline = {{0, 0}};
  for (int i = 0; i < count; ++i) {
    const int x = 20 * i + 2 + static_cast<int>(random.below(8)), y = 1 + static_cast<int>(random.below(40));
    const int right = x + 1 + static_cast<int>(random.below(8)),
              top = y + 1 + static_cast<int>(random.below(50));
    outline.insert(outline.end(), {{x, 0}, {x, y}, {x, top}, {right, top}, {right, y}, {x, y}, {x, 0}});
  }
  outline.insert(outline.end(), {{20 * count + 20, 0}, {20 * count + 20, 100}, {0, 100}});
  return outline;
}

// A bar with teeth upwards, of random lengths.
inline Outline comb_outline(Random& random, std::uint32_t teeth) {
  Outline outline = {{0, 0}, {4 * static_cast<int>(teeth), 0}};
  for (int i = static_cast<int>(teeth) - 1; i >= 0; --i) {
    const int top = 10 + static_cast<int>(random.below(1000));
    outline.insert(outline.end(), {{4 * i + 4, top}, {4 * i + 3, 5}, {4 * i + 1, 5}, {4 * i, top}});
  }
  return outline;
}

// Corners that stand twice, corners in the middle of edges, and edges that go out and back, anywhere. Changes
// no area but by the factor 4, for it doubles all coordinates.
inline Outline decorated(const Outline& plain, Random& random) {
  Outline outline;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const glm::ivec2 a = 2 * plain[i], b = 2 * plain[(i + 1) % plain.size()];
    outline.push_back(a);
    switch (random.below(12)) {
      case 0:
        outline.insert(outline.end(), 1 + random.below(2), a);
        break;
      case 1:
        outline.push_back((a + b) / 2);
        break;
      case 2:
        outline.push_back(2 * plain[random.below(static_cast<std::uint32_t>(plain.size()))]);
        outline.push_back(a);
        break;
      case 3:
        outline.insert(outline.end(), {(a + b) / 2, a, (a + b) / 2});
        break;
      case 4: {
        const int x = static_cast<int>(random.below(21)), y = static_cast<int>(random.below(21));
        outline.push_back(a + glm::ivec2{x - 10, y - 10});
        outline.push_back(a);
        break;
      }
      default:
        break;
    }
  }
  return outline;
}

}  // namespace coppice
