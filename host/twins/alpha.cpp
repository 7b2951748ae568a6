#include "twins/alpha.h"

#include <bit>
#include <cmath>

#include "twins/texel_place.h"

namespace coppice::twins {

namespace {

uint hash_of_word(uint word) {
  const uint state = word * 747796405u + 2891336453u;
  const uint mixed = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return mixed ^ (mixed >> 22);
}

uint wrap_of(const AlphaMap& map, int axis) {
  return (map.flags >> (axis == 0 ? TEXTURE_WRAP_U_SHIFT : TEXTURE_WRAP_V_SHIFT)) & TEXTURE_WRAP_MASK;
}

}  // namespace

uint Alpha::key_of(const Ray& ray) {
  uint key = 0;
  for (const vec3& vector : {ray.origin, ray.direction}) {
    for (int axis = 0; axis < 3; ++axis) key = hash_of_word(std::bit_cast<uint>(vector[axis]) ^ key);
  }
  return key;
}

float Alpha::texel(const AlphaMap& map, long x, long y) const {
  const uint column = on_axis(x, map.width, wrap_of(map, 0)), row = on_axis(y, map.height, wrap_of(map, 1));
  const uint at = map.first_texel + row * map.width + column;
  return static_cast<float>((texels_[at / 4] >> (at % 4 * 8)) & 0xff);
}

float Alpha::code_at(const AlphaMap& map, vec2 place) const {
  const float x = place.x * static_cast<float>(map.width) - 0.5f;
  const float y = place.y * static_cast<float>(map.height) - 0.5f;
  const long left = std::lrint(std::floor(x)), top = std::lrint(std::floor(y));
  const float across = x - std::floor(x), down = y - std::floor(y);
  const auto row = [&](long at) {
    const float first = texel(map, left, at), step = texel(map, left + 1, at) - first;
    return first + step * across;
  };
  const float upper = row(top), step = row(top + 1) - upper;
  return upper + step * down;
}

bool Alpha::lets_through(const Hit& hit) const {
  if (triangles_.value == 0) return false;
  const AlphaTriangle& triangle = triangles_[hit.triangle];
  if (triangle.map == ALPHA_SOLID) return false;
  if (triangle.map == ALPHA_NOTHING) return true;
  const AlphaMap& map = maps_[triangle.map];
  const float w = 1.0f - hit.u - hit.v;
  vec2 place;
  for (int axis = 0; axis < 2; ++axis) {
    const float uv =
        triangle.texcoord_a[axis] * w + triangle.texcoord_b[axis] * hit.u + triangle.texcoord_c[axis] * hit.v;
    const float scaled = uv * map.scale[axis];
    place[axis] = unit_place(scaled + map.offset[axis], wrap_of(map, axis));
  }
  const float code = code_at(map, place);
  if (map.is_coverage == 0) return code < map.threshold;
  const float random = static_cast<float>(hash_of_word(key_ ^ hit.triangle) >> 8) * 0x1p-24f;
  return code <= random * map.threshold;
}

}  // namespace coppice::twins
