#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "builders/clip.h"
#include "builders/leaves.h"
#include "scene/random.h"

namespace coppice {
namespace {

constexpr float LARGEST = std::numeric_limits<float>::max();
constexpr float LEAST = std::numeric_limits<float>::denorm_min();

GrowingBox box_of(const Triangle& triangle) {
  const Aabb box = triangle_box(triangle);
  return {box.box_min, box.box_max};
}

bool operator==(const GrowingBox& a, const GrowingBox& b) {
  return a.box_min == b.box_min && a.box_max == b.box_max;
}

bool is_inside(const GrowingBox& inner, const GrowingBox& outer) {
  GrowingBox both = outer;
  both.grow(inner);
  return both == outer;
}

// Only for planes strictly inside of the triangle's box.
ClippedBoxes clip(const Triangle& triangle, int axis, float plane) {
  return clip_at_plane(triangle, box_of(triangle), axis, plane);
}

// A long double has 11 bits more than the double in which the code computes.
bool holds(const GrowingBox& box, const long double (&point)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.box_min[axis] || point[axis] > box.box_max[axis]) return false;
  }
  return true;
}

// Where the edge from a to b crosses the plane.
void expect_crossing_in_both(const ClippedBoxes& sides, const vec3& a, const vec3& b, int axis, float plane) {
  if (!((a[axis] < plane && plane < b[axis]) || (b[axis] < plane && plane < a[axis]))) return;
  const long double t =
      (static_cast<long double>(plane) - a[axis]) / (static_cast<long double>(b[axis]) - a[axis]);
  long double point[3];
  for (int k = 0; k < 3; ++k) point[k] = a[k] + t * (static_cast<long double>(b[k]) - a[k]);
  point[axis] = plane;
  EXPECT_TRUE(holds(sides.left, point));
  EXPECT_TRUE(holds(sides.right, point));
}

TEST(ClipAtPlane, CutsATriangleInTwo) {
  const Triangle triangle{vec3(0, 0, 0), vec3(4, 4, 0), vec3(0, 4, 1)};
  const ClippedBoxes sides = clip(triangle, 0, 1);
  EXPECT_EQ(sides.left.box_min, vec3(0, 0, 0));
  EXPECT_EQ(sides.left.box_max, vec3(1, 4, 1));
  EXPECT_EQ(sides.right.box_max.x, 4);
  EXPECT_EQ(sides.right.box_max.y, 4);
  EXPECT_EQ(sides.right.box_min.x, 1);
}

TEST(ClipAtPlane, RoundsOutwardByAtMostAnUlp) {
  const Triangle triangle{vec3(0, 0, 0), vec3(4, 4, 0), vec3(0, 4, 1)};
  const float low = clip(triangle, 0, 1).right.box_min.y;  // 1 but for the rounding
  EXPECT_LE(low, 1.0f);
  EXPECT_GE(low, std::nextafter(1.0f, 0.0f));
}

TEST(ClipAtPlane, KeepsACornerInThePlaneOnBothSides) {
  const Triangle triangle{vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 5, 0)};
  const ClippedBoxes sides = clip(triangle, 0, 0);
  EXPECT_EQ(sides.left.box_max, vec3(0, 5, 0));
  EXPECT_EQ(sides.right.box_max, vec3(1, 5, 0));
}

TEST(ClipAtPlane, StaysInsideOfTheBoxOfThePart) {
  const Triangle triangle{vec3(0, 0, 0), vec3(4, 4, 0), vec3(0, 4, 1)};
  const GrowingBox part{vec3(0.5f, 1, 0), vec3(3, 2, 0.5f)};
  const ClippedBoxes sides = clip_at_plane(triangle, part, 0, 1);
  EXPECT_TRUE(is_inside(sides.left, part));
  EXPECT_TRUE(is_inside(sides.right, part));
}

TEST(ClipAtPlane, LeavesASideEmptyThatThePartDoesNotReach) {
  const Triangle triangle{vec3(0, 0, 0), vec3(4, 4, 0), vec3(0, 4, 0)};
  const GrowingBox part{vec3(0, 0, 0), vec3(4, 0.5f, 0)};
  EXPECT_FALSE(clip_at_plane(triangle, part, 0, 1).left.is_empty());
  EXPECT_TRUE(clip_at_plane(triangle, part, 0, 1).right.is_empty());
}

TEST(ClipAtPlane, FindsTheSameCrossingFromBothEndsOfAnEdge) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const vec3 a = random.in_cube(), b = random.in_cube();
    const float plane = a.x + 0.5f * (b.x - a.x);
    const ClippedBoxes there = clip({a, b, a}, 0, plane), back = clip({b, b, a}, 0, plane);
    EXPECT_TRUE(there.left == back.left && there.right == back.right);
  }
}

TEST(ClipAtPlane, HoldsTheCrossingsOfAllEdges) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    // Corners of magnitudes from 2^-60 to 2^60.
    vec3 corners[3];
    for (vec3& corner : corners) {
      const int exponent = static_cast<int>(random.below(120)) - 60;
      corner = random.in_cube() * std::ldexp(1.0f, exponent);
    }
    const Triangle triangle{corners[0], corners[1], corners[2]};
    const int axis = static_cast<int>(random.below(3));
    const GrowingBox box = box_of(triangle);
    const float plane = box.box_min[axis] + random.uniform() * (box.box_max[axis] - box.box_min[axis]);
    if (!(box.box_min[axis] < plane && plane < box.box_max[axis])) continue;
    const ClippedBoxes sides = clip(triangle, axis, plane);
    for (int k = 0; k < 3; ++k) {
      expect_crossing_in_both(sides, corners[k], corners[(k + 1) % 3], axis, plane);
    }
  }
}

TEST(ClipAtPlane, TakesTheWholeRangeOfFloat) {
  const Triangle triangles[] = {
      {vec3(-LARGEST, LARGEST, -LARGEST), vec3(LARGEST, -LARGEST, LARGEST), vec3(LARGEST)},
      {vec3(-LEAST, LEAST, -LEAST), vec3(LEAST, -LEAST, LEAST), vec3(LEAST)},
      {vec3(-LARGEST, LEAST, -LEAST), vec3(LARGEST, -LEAST, LEAST), vec3(LEAST)},
      {vec3(-LEAST, LARGEST, 0), vec3(LEAST, -LARGEST, LEAST), vec3(0, 0, LARGEST)},
  };
  for (const Triangle& triangle : triangles) {
    const ClippedBoxes sides = clip(triangle, 0, 0);
    EXPECT_TRUE(is_inside(sides.left, box_of(triangle)));
    EXPECT_TRUE(is_inside(sides.right, box_of(triangle)));
    expect_crossing_in_both(sides, triangle.a, triangle.b, 0, 0);
  }
}

TEST(GrowingBox, HasAnAreaBeyondTheRangeOfFloat) {
  const GrowingBox box{vec3(-LARGEST), vec3(LARGEST)};
  EXPECT_DOUBLE_EQ(box.half_area(), 12.0 * double{LARGEST} * LARGEST);
}

TEST(GrowingBox, HasNoAreaWhereItIsEmpty) { EXPECT_EQ(GrowingBox{}.half_area(), 0.0); }

}  // namespace
}  // namespace coppice
