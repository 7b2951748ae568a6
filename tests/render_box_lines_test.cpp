// Boxes of a tree as lines in a picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/box_lines.h"
#include "render/film.h"

namespace coppice {
namespace {

// From (0, 0, 5) along -z at a picture of 100 x 80 with 90 degrees.
Film film_of_test() { return make_film(Scene(), std::vector<double>{0, 0, 5, 0, 0, 0, 90}, 100, 80, 1); }

Node box(vec3 from, vec3 to, uint child, uint height) { return {from, child, to, height}; }

TEST(BoxLines, TheEdgesOfABoxAreWhereItsCornersAre) {
  const std::vector<Node> nodes = {box(vec3(-1), vec3(1), 0, 0)};
  const std::vector<BoxLine> lines = box_lines(nodes, film_of_test(), 7, BOXES_SHOWN);
  ASSERT_EQ(lines.size(), 12u);
  // The near face is 4 away: 40 pixels a unit at distance 1, so 10.
  const auto is_corner = [](float x, float y, float size) {
    return std::abs(std::abs(x - 50) - size) < 1e-3f && std::abs(std::abs(y - 40) - size) < 1e-3f;
  };
  int near_corners = 0, far_corners = 0;
  for (const BoxLine& line : lines) {
    for (int end = 0; end < 2; ++end) {
      near_corners += is_corner(line.x[end], line.y[end], 10);
      far_corners += is_corner(line.x[end], line.y[end], 40.0f / 6);
    }
  }
  EXPECT_EQ(near_corners, 12);
  EXPECT_EQ(far_corners, 12);
}

TEST(BoxLines, BehindTheEyeIsNothingAndWhatReachesThereIsCutOff) {
  const Film film = film_of_test();
  EXPECT_TRUE(box_lines(std::vector<Node>{box(vec3(-1, -1, 6), vec3(1, 1, 9), 0, 0)}, film, 0, 1).empty());
  const auto lines = box_lines(std::vector<Node>{box(vec3(-1, -1, 0), vec3(1, 1, 9), 0, 0)}, film, 0, 1);
  EXPECT_EQ(lines.size(), 8u);
  for (const BoxLine& line : lines) EXPECT_TRUE(std::isfinite(line.x[0] + line.x[1] + line.y[0] + line.y[1]));
}

TEST(BoxLines, LevelsStopAtTheLimitAndAtLeaves) {
  std::vector<Node> nodes = {box(vec3(-1), vec3(1), 1, 2), box(vec3(-1), vec3(0), 0, 0),
                             box(vec3(0), vec3(1), 3, 1), box(vec3(0), vec3(1), 1, 0),
                             box(vec3(0), vec3(1), 2, 0)};
  const Film film = film_of_test();
  EXPECT_EQ(box_lines(nodes, film, 0, 100).size(), 12u);
  EXPECT_EQ(box_lines(nodes, film, 1, 100).size(), 36u);
  EXPECT_EQ(box_lines(nodes, film, 9, 100).size(), 60u);
  EXPECT_EQ(box_lines(nodes, film, 9, 4).size(), 36u);
  EXPECT_EQ(box_lines({}, film, 9, 4).size(), 0u);
}

TEST(BoxLines, ALineIsDrawnFromEndToEndAndNothingBesideThePicture) {
  std::vector<uint> image(20 * 10, 0xffffffff);
  const std::vector<BoxLine> lines = {{{-1e6f, 1e6f}, {5.5f, 5.5f}, 1}};
  draw_box_lines(image, 20, 10, lines, 1);
  const auto colour = colour_of_level(1, 1);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      const uint expected =
          y == 5 ? 0xff000000 | uint{colour[2]} << 16 | uint{colour[1]} << 8 | colour[0] : 0xff7f7f7f;
      EXPECT_EQ(image[y * 20 + x], expected) << x << ", " << y;
    }
  }
  const std::vector<BoxLine> outside = {{{-5, 30}, {-3, -3}, 0}, {{25, 25}, {0, 9}, 0}};
  const std::vector<uint> before(20 * 10, 0xff7f7f7f);
  image.assign(20 * 10, 0xffffffff);
  draw_box_lines(image, 20, 10, outside, 1);
  EXPECT_EQ(image, before);
}

}  // namespace
}  // namespace coppice
