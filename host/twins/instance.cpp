#include "twins/instance.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "twins/finite.h"

namespace coppice::twins {

namespace {

float times(float a, float b) { return flushed(a * b); }
float plus(float a, float b) { return flushed(a + b); }

// Three terms, from the first to the last.
template <class Term>
float total(Term term) {
  return plus(plus(term(0), term(1)), term(2));
}

// The power of two that brings the largest of a column to [1, 2), as far as it is one.
float scale_of(const Affine& a, int column) {
  int exponent = -126;
  for (int row = 0; row < 3; ++row)
    if (a.at[row][column] != 0) exponent = std::max(exponent, std::ilogb(a.at[row][column]));
  return std::ldexp(1.0f, -std::min(exponent, 126));
}

// Newton's iteration from a line, on the number's fraction in [1/2, 1).
float nearly_one_over(float x) {
  int exponent;
  const float part = std::frexp(std::fabs(x), &exponent);
  float guess = 2.82352948f - 1.88235295f * part;
  for (int step = 0; step < 3; ++step) guess = guess * (2.0f - part * guess);
  return std::copysign(std::ldexp(guess, -exponent), x);
}

// Cramer's rule on columns of about one size.
bool nearly_invert(const Affine& a, float (&inverse)[3][3]) {
  float scale[3], unit[3][3], cofactor[3][3];  // unit: by row and column
  for (int column = 0; column < 3; ++column) {
    scale[column] = scale_of(a, column);
    for (int row = 0; row < 3; ++row) unit[row][column] = times(a.at[row][column], scale[column]);
  }
  for (int column = 0; column < 3; ++column) {
    const int next = (column + 1) % 3, last = (column + 2) % 3;
    for (int row = 0; row < 3; ++row) {
      const int below = (row + 1) % 3, lowest = (row + 2) % 3;
      cofactor[row][column] =
          plus(times(unit[below][next], unit[lowest][last]), -times(unit[lowest][next], unit[below][last]));
    }
  }
  const float determinant = total([&](int row) { return times(unit[row][0], cofactor[row][0]); });
  if (determinant == 0) return false;
  const float by = nearly_one_over(determinant);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) inverse[i][k] = times(times(cofactor[k][i], by), scale[i]);
  }
  return true;
}

struct PadAndRoom {
  float pad, room;
};

float row_sum(const float (&row)[3]) {
  return total([&](int k) { return std::fabs(row[k]); });
}

// docs/numerics.md, "Instances".
PadAndRoom pad_of(const Affine& a, const float (&inverse)[3], int axis, const float (&reach)[3],
                  const float (&way)[3]) {
  const float room = times(0x1p-19f, row_sum(inverse));
  const float from_rest = total([&](int j) {
    const float product = total([&](int k) { return times(inverse[k], a.at[k][j]); });
    return times(std::fabs(plus(j == axis ? 1.0f : 0.0f, -product)), reach[j]);
  });
  const float moved =
      total([&](int k) { return times(std::fabs(inverse[k]), plus(way[k], std::fabs(a.at[k][3]))); });
  const float from_rounding = times(0x1p-20f, plus(reach[axis], moved));
  const float from_room = times(room, std::max({way[0], way[1], way[2]}));
  const float least = times(0x1p-120f, plus(plus(row_sum(reach), row_sum(inverse)), 1.0f));
  return {plus(times(plus(plus(from_rest, from_rounding), from_room), 1.0f + 0x1p-10f), least), room};
}

}  // namespace

Affine::Affine(const InstanceTransform& t) {
  const vec3* const rows[] = {&t.row_x, &t.row_y, &t.row_z};
  const float moves[] = {t.move_x, t.move_y, t.move_z};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      at[row][column] = flushed(column == 3 ? moves[row] : (*rows[row])[column]);
  }
}

bool Affine::is_finite() const {
  return std::ranges::all_of(at, [](const auto& row) {
    return std::ranges::all_of(row, [](float entry) { return std::isfinite(entry); });
  });
}

vec3 Affine::operator()(const vec3& position) const {
  vec3 moved;
  for (int row = 0; row < 3; ++row) {
    moved[row] =
        plus(total([&](int column) { return times(at[row][column], position[column]); }), at[row][3]);
  }
  return moved;
}

Aabb Affine::operator()(const Aabb& box) const {
  Aabb moved;
  for (int row = 0; row < 3; ++row) {
    const auto ends = [&](int column) {
      return std::minmax(
          {times(at[row][column], box.box_min[column]), times(at[row][column], box.box_max[column])});
    };
    const float low = plus(total([&](int column) { return ends(column).first; }), at[row][3]);
    const float high = plus(total([&](int column) { return ends(column).second; }), at[row][3]);
    moved.box_min[row] = std::isfinite(low) ? low : -FLT_MAX;
    moved.box_max[row] = std::isfinite(high) ? high : FLT_MAX;
  }
  return moved;
}

PlacedInstance place(const Affine& transform, const Aabb& mesh_box, uint mesh) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float low = 0x1p-60f, high = 0x1p60f;
  float reach[3], way[3];
  for (int axis = 0; axis < 3; ++axis)
    reach[axis] = std::max(std::fabs(mesh_box.box_min[axis]), std::fabs(mesh_box.box_max[axis]));
  for (int row = 0; row < 3; ++row)
    way[row] = total([&](int column) { return times(std::fabs(transform.at[row][column]), reach[column]); });
  float inverse[3][3];
  PadAndRoom pads[3];
  bool is_good = nearly_invert(transform, inverse);
  for (int axis = 0; axis < 3 && is_good; ++axis) {
    pads[axis] = pad_of(transform, inverse[axis], axis, reach, way);
    const float sum = row_sum(inverse[axis]);
    is_good = sum >= low && sum <= high && pads[axis].pad <= high && reach[axis] <= high &&
              plus(way[axis], std::fabs(transform.at[axis][3])) <= high;
  }
  if (!is_good) return {vec3(0), 1, vec3(0), 1, vec3(0), 1, vec3(infinity), mesh};
  const auto row = [&](int axis) { return vec3(inverse[axis][0], inverse[axis][1], inverse[axis][2]); };
  return {row(0),
          pads[0].room,
          row(1),
          pads[1].room,
          row(2),
          pads[2].room,
          vec3(pads[0].pad, pads[1].pad, pads[2].pad),
          mesh};
}

}  // namespace coppice::twins
