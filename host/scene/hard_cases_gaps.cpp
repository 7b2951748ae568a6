// Chains: the nearest neighbour of each triangle is the next one, so that a clustering by mutual nearest
// neighbours merges one pair a round unless it has a rule against it.
#include <cmath>
#include <glm/ext/vector_double2.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice::hard {
namespace {

// A triangle in the plane z = 0 with a right angle at its lower left corner.
void append_flat(Scene& scene, double x, double y, double width, double height) {
  const auto left = static_cast<float>(x), right = static_cast<float>(x + width);
  const auto bottom = static_cast<float>(y), top = static_cast<float>(y + height);
  append_triangle(scene, {left, bottom, 0}, {right, bottom, 0}, {left, top, 0}, 0);
}

// The side of the smallest square grid that has `count` places.
std::uint32_t side_of(std::uint32_t count) {
  auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count)));
  while (std::uint64_t{side} * side < count) ++side;
  return side;
}

// The least k, 1 or more, for which `count` steps by the factor 1 - 2^-k leave at least 2^-48 or so of a
// length.
int shrink_exponent(std::uint32_t count) {
  constexpr double binades = 48, binades_a_step = 1.4427;  // for each 2^-k
  int k = 1;
  while (count * binades_a_step > std::ldexp(binades, k)) ++k;
  return k;
}

// The powers of 1 - 2^-k.
std::vector<double> powers(std::uint32_t count, int k) {
  std::vector<double> places;
  double x = 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    places.push_back(x);
    x -= std::ldexp(x, -k);
  }
  return places;
}

}  // namespace

// A row along x in which the nearest neighbour of each triangle, by surface area of the union box, is the
// next one, so that a clustering by mutual nearest neighbours merges one pair a round. The obvious row, with
// gaps that shrink, runs out of float: in each binade of the position a gap can shrink by an ulp some 2,400
// times only. So the places stay put and the heights shrink: box i is [3i, 3i + 1] x [0, 1 - (i + 1) 2^-24] x
// {0}; the union of i and i + 1 is 4 by the height of i, whose area falls from each i to the next. All of
// this is exact in float up to i = (2^24 - 1) / 3, which is 5,592,405; beyond that the coordinates round and
// boxes begin to coincide. The order along the row is also the order of the Morton codes (with ties in index
// order) on a grid of cubic cells, 2^10 or 2^20 a side, a power of two wide, that starts at the scene's
// corner: all centres fall into one row of its cells.
Scene shrinking_gaps(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float x = 3.0f * static_cast<float>(i);
    const float height = 1.0f - static_cast<float>(i + 1) * 0x1p-24f;
    append_triangle(scene, {x, 0, 0}, {x + 1, 0, 0}, {x, height, 0}, 0);
  }
  return scene;
}

// The gaps of every row shrink from 1 by 2^-13 a step, those between rows from 2 by 2^-12: the next one in
// the row is always nearer. Exact in float up to a million triangles or so; the largest grid, of 8,192 a
// side, loses the last bits.
Scene shrinking_gaps_plane(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  const std::uint32_t columns = side_of(triangle_count);
  const auto place = [](double k) { return k - k * (k - 1) * 0x1p-14; };
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    append_flat(scene, place(i % columns), 2 * place(i / columns), 0x1p-14, 0x1p-14);
  }
  return scene;
}

// A spiral whose arms are 2 apart. The gaps, measured along the chord, shrink evenly from 1 to 1/2 in all;
// beyond some 20,000 triangles they become uneven, since they shrink by less than an ulp of the places.
Scene shrinking_gaps_spiral(std::uint32_t triangle_count, std::uint64_t) {
  constexpr double arm_a_radian = 2 / 6.283185307179586;
  Scene scene = reserved_scene(triangle_count);
  glm::dvec2 direction{1, 0};
  double radius = 16;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    append_flat(scene, radius * direction.x, radius * direction.y, 0x1p-6, 0x1p-6);
    const double gap = 1 - 0.5 * i / triangle_count;
    const double half_sine = gap / (2 * radius);
    const double cosine = 1 - 2 * half_sine * half_sine;
    const double sine = 2 * half_sine * std::sqrt(1 - half_sine * half_sine);
    direction = {direction.x * cosine - direction.y * sine, direction.x * sine + direction.y * cosine};
    radius += arm_a_radian * 2 * half_sine;
  }
  return scene;
}

// A row towards x = 0, where floats are dense: the triangle at x is a quarter of the gap after it wide and
// high, and the gap is x / 2^k. With up to some 60,000 triangles rounding does not disturb the order of the
// areas.
Scene geometric_gaps(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  const int k = shrink_exponent(triangle_count);
  for (const double x : powers(triangle_count, k)) {
    append_flat(scene, x, 0, std::ldexp(x, -k - 2), std::ldexp(x, -k - 2));
  }
  return scene;
}

// The same in both directions, towards the origin. The triangles are half as high, in their gaps, as they are
// wide, so that the next one in the row is nearer, by the area of the union box, than that in the next row.
Scene geometric_gaps_plane(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  const std::uint32_t columns = side_of(triangle_count);
  const int k = shrink_exponent(columns);
  const std::vector<double> places = powers(columns, k);
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const double x = places[i % columns], y = places[i / columns];
    append_flat(scene, x, y, std::ldexp(x, -k - 2), std::ldexp(y, -k - 3));
  }
  return scene;
}

// Each step multiplies a complex number by (1 - 2^-k) (1 + i t) / (1 - i t), a turn by 2 atan(t). With t =
// 2^(-k/2) the next place is nearer than the next arm, by half.
Scene geometric_gaps_spiral(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = reserved_scene(triangle_count);
  int k = shrink_exponent(triangle_count);
  k = k < 6 ? 6 : k + k % 2;
  const double t = std::ldexp(1.0, -k / 2), factor = (1 - t * t) / (1 + t * t);  // 1 - 2^-k = 1 - t^2
  const double cosine = (1 - t * t) * factor, sine = (1 - t * t) * 2 * t / (1 + t * t);
  glm::dvec2 p{1, 0};
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const double size = 0.25 * t * std::sqrt(p.x * p.x + p.y * p.y);  // the gap is 2t of the radius
    append_flat(scene, p.x, p.y, size, size);
    p = {p.x * cosine - p.y * sine, p.x * sine + p.y * cosine};
  }
  return scene;
}

}  // namespace coppice::hard
