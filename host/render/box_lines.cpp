#include "render/box_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "render/show.h"

namespace coppice {

namespace {

// Where points are on a film, in double.
class Projection {
 public:
  explicit Projection(const Film& film)
      : eye_(film.position),
        right_(film.right),
        down_(film.down),
        width_(film.width),
        height_(film.height),
        forward_(glm::dvec3(film.corner) + right_ * (0.5 * width_) + down_ * (0.5 * height_)) {}

  // False where nothing of the segment is in front of the eye.
  bool line(glm::dvec3 a, glm::dvec3 b, BoxLine& line) const {
    a -= eye_;
    b -= eye_;
    double depth_a = glm::dot(a, forward_), depth_b = glm::dot(b, forward_);
    const double least = 1e-4 * std::max(std::abs(depth_a), std::abs(depth_b));
    if (!(depth_a > least || depth_b > least)) return false;
    if (depth_a < least) a += (b - a) * ((least - depth_a) / (depth_b - depth_a));
    if (depth_b < least) b += (a - b) * ((least - depth_b) / (depth_a - depth_b));
    set(a, line.x[0], line.y[0]);
    set(b, line.x[1], line.y[1]);
    return std::isfinite(line.x[0] + line.y[0] + line.x[1] + line.y[1]);
  }

 private:
  void set(glm::dvec3 from_eye, float& x, float& y) const {
    const double depth = glm::dot(from_eye, forward_);
    x = static_cast<float>(glm::dot(from_eye, right_) / glm::dot(right_, right_) / depth + 0.5 * width_);
    y = static_cast<float>(glm::dot(from_eye, down_) / glm::dot(down_, down_) / depth + 0.5 * height_);
  }

  glm::dvec3 eye_, right_, down_;
  double width_, height_;
  glm::dvec3 forward_;
};

void add_edges(const Node& node, std::uint32_t level, const Projection& projection,
               std::vector<BoxLine>& lines) {
  const auto corner = [&](int bits) {
    return glm::dvec3(bits & 1 ? node.box_max.x : node.box_min.x, bits & 2 ? node.box_max.y : node.box_min.y,
                      bits & 4 ? node.box_max.z : node.box_min.z);
  };
  for (int axis = 1; axis < 8; axis *= 2) {
    for (int from = 0; from < 8; ++from) {
      BoxLine line{{}, {}, level};
      if (!(from & axis) && projection.line(corner(from), corner(from | axis), line)) lines.push_back(line);
    }
  }
}

// Cuts the line off at the rectangle (Liang and Barsky 1984). False where nothing is left.
bool cut_off(BoxLine& line, float width, float height) {
  const float dx = line.x[1] - line.x[0], dy = line.y[1] - line.y[0];
  const std::pair<float, float> planes[] = {
      {-dx, line.x[0]}, {dx, width - line.x[0]}, {-dy, line.y[0]}, {dy, height - line.y[0]}};
  float begin = 0, end = 1;
  for (const auto& [direction, distance] : planes) {
    if (direction == 0 && distance < 0) return false;
    if (direction < 0) begin = std::max(begin, distance / direction);
    if (direction > 0) end = std::min(end, distance / direction);
  }
  if (begin > end) return false;
  line = {{line.x[0] + begin * dx, line.x[0] + end * dx},
          {line.y[0] + begin * dy, line.y[0] + end * dy},
          line.level};
  return true;
}

void blend(uint& pixel, const std::array<std::uint8_t, 3>& colour, float part) {
  for (int channel = 0; channel < 3; ++channel) {
    const float before = static_cast<float>(pixel >> (8 * channel) & 255);
    const float after = before + (static_cast<float>(colour[channel]) - before) * part;
    pixel = (pixel & ~(255u << (8 * channel))) | static_cast<uint>(std::lround(after)) << (8 * channel);
  }
}

// Of two pixels beside the line each has its part (Wu 1991).
void draw_line(std::span<uint> image, int width, int height, BoxLine line,
               const std::array<std::uint8_t, 3>& colour) {
  const bool steep = std::abs(line.y[1] - line.y[0]) > std::abs(line.x[1] - line.x[0]);
  const float* const along = steep ? line.y : line.x;
  const float* const across = steep ? line.x : line.y;
  const int first = along[0] <= along[1] ? 0 : 1, last = 1 - first;
  const float slope = along[0] == along[1] ? 0 : (across[1] - across[0]) / (along[1] - along[0]);
  for (int step = static_cast<int>(along[first]); step <= static_cast<int>(along[last]); ++step) {
    const float at = across[first] + slope * (static_cast<float>(step) + 0.5f - along[first]) - 0.5f;
    const float below = std::floor(at);
    for (int k = 0; k < 2; ++k) {
      const int side = static_cast<int>(below) + k;
      const int x = steep ? side : step, y = steep ? step : side;
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      blend(image[static_cast<std::size_t>(y) * width + x], colour, k == 0 ? 1 - (at - below) : at - below);
    }
  }
}

}  // namespace

std::vector<BoxLine> box_lines(std::span<const Node> nodes, const Film& film, std::uint32_t level,
                               std::uint32_t limit) {
  std::vector<BoxLine> lines;
  if (nodes.empty()) return lines;
  const Projection projection(film);
  std::vector<uint> here = {0}, below;
  std::size_t boxes = 0;
  for (std::uint32_t its = 0; its <= level && !here.empty() && (its == 0 || boxes + here.size() <= limit);
       ++its) {
    boxes += here.size();
    below.clear();
    for (const uint index : here) {
      const Node& node = nodes[index];
      add_edges(node, its, projection, lines);
      if (node.height != 0) below.insert(below.end(), {node.child, node.child + 1});
    }
    here.swap(below);
  }
  return lines;
}

std::array<std::uint8_t, 3> colour_of_level(std::uint32_t level, std::uint32_t last) {
  return turbo_code(0.12 + 0.76 * (last == 0 ? 1.0 : static_cast<double>(level) / last));
}

void draw_box_lines(std::span<uint> image, std::uint32_t width, std::uint32_t height,
                    std::span<const BoxLine> lines, std::uint32_t last_level) {
  for (uint& pixel : image) pixel = (pixel >> 1 & 0x7f7f7f) | 0xff000000;
  for (BoxLine line : lines) {
    if (!cut_off(line, static_cast<float>(width) - 1e-3f, static_cast<float>(height) - 1e-3f)) continue;
    draw_line(image, static_cast<int>(width), static_cast<int>(height), line,
              colour_of_level(line.level, last_level));
  }
}

}  // namespace coppice
