#include "twins/environment.h"

#include <algorithm>
#include <cmath>

#include "twins/vectors.h"

namespace coppice::twins {

namespace {

class Map {
 public:
  explicit Map(const Surroundings& at) : at_(at), side_(at[0].end) {}

  uint side() const { return side_; }

  vec3 radiance(float x, float y) const {
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float u = x - 0.5f - left, v = y - 0.5f - top;
    const int column = static_cast<int>(left), row = static_cast<int>(top);
    const auto between = [](const vec3& a, const vec3& b, float part) { return a + (b - a) * part; };
    return between(between(texel(column, row), texel(column + 1, row), u),
                   between(texel(column, row + 1), texel(column + 1, row + 1), u), v);
  }

  float density(uint column, uint row, const vec3& place) const {
    const float squared = dot_product(place, place);
    const uint share = end(of_row(row), column) - start(of_row(row), column);
    return at_[rows() + row].radiance.x * static_cast<float>(share) * (squared * std::sqrt(squared));
  }

  // Which of the shares that begin at `first` a number from 0 to 1 is in, and where, in texels.
  float pick(uint first, float u, float within, uint& index) const {
    const auto number = static_cast<uint>(u * static_cast<float>(ENVIRONMENT_RANGE));
    const Surrounding* const begin = &at_[first];
    index = static_cast<uint>(std::partition_point(begin, begin + side_ - 1,
                                                   [&](const Surrounding& s) { return s.end <= number; }) -
                              begin);
    const uint from = start(first, index);
    return static_cast<float>(index) +
           (static_cast<float>(number - from) + within) / static_cast<float>(end(first, index) - from);
  }

  uint rows() const { return 1 + side_ * side_; }
  uint of_row(uint row) const { return 1 + side_ * row; }

 private:
  uint end(uint first, uint index) const { return at_[first + index].end; }
  uint start(uint first, uint index) const { return index == 0 ? 0 : end(first, index - 1); }

  // One beyond an edge is that which lies mirrored at the edge's middle.
  vec3 texel(int column, int row) const {
    const int last = static_cast<int>(side_) - 1;
    if (column < 0 || column > last) {
      column = column < 0 ? 0 : last;
      row = last - row;
    }
    if (row < 0 || row > last) {
      row = row < 0 ? 0 : last;
      column = last - column;
    }
    return at_[of_row(static_cast<uint>(row)) + static_cast<uint>(column)].radiance;
  }

  const Surroundings& at_;
  uint side_;
};

float signed_one(float x) { return x < 0 ? -1.0f : 1.0f; }

}  // namespace

EnvironmentLight environment_in(const Surroundings& surroundings, const vec3& direction) {
  const Map map(surroundings);
  const float sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  const vec3 place(direction.x / sum, direction.y / sum, direction.z / sum);
  float s = place.x, t = place.z;
  if (place.y < 0) {
    s = (1.0f - std::fabs(place.z)) * signed_one(place.x);
    t = (1.0f - std::fabs(place.x)) * signed_one(place.z);
  }
  const float half = 0.5f * static_cast<float>(map.side());
  const float x = (s + 1.0f) * half, y = (t + 1.0f) * half;
  const uint last = map.side() - 1;
  return {map.radiance(x, y),
          map.density(std::min(static_cast<uint>(x), last), std::min(static_cast<uint>(y), last), place)};
}

EnvironmentSample sample_environment(const Surroundings& surroundings, const glm::vec2& u,
                                     const glm::vec2& in_texel) {
  const Map map(surroundings);
  uint column = 0, row = 0;
  const float y = map.pick(map.rows(), u.y, in_texel.y, row);
  const float x = map.pick(map.of_row(row), u.x, in_texel.x, column);
  const float texel = 2.0f / static_cast<float>(map.side());
  const float s = x * texel - 1.0f, t = y * texel - 1.0f;
  vec3 place(s, 1.0f - std::fabs(s) - std::fabs(t), t);
  if (place.y < 0) {
    place.x = (1.0f - std::fabs(t)) * signed_one(s);
    place.z = (1.0f - std::fabs(s)) * signed_one(t);
  }
  return {place, {map.radiance(x, y), map.density(column, row, place)}};
}

}  // namespace coppice::twins
