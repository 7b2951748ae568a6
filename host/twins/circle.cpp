#include "twins/circle.h"

#include <cmath>
#include <cstddef>

#include "interface/circle.h"

namespace coppice::twins {

namespace {

// By Horner's rule.
template <std::size_t N>
float polynomial(const float (&coefficients)[N], float y) {
  float value = coefficients[N - 1];
  for (std::size_t k = N - 1; k-- > 0;) value = coefficients[k] + y * value;
  return value;
}

}  // namespace

OnCircle circle_beside_quarter(int whole, float x) {
  static const float for_cos[] = {TURN_COS_0, TURN_COS_1, TURN_COS_2, TURN_COS_3, TURN_COS_4};
  static const float for_sin[] = {TURN_SIN_0, TURN_SIN_1, TURN_SIN_2, TURN_SIN_3, TURN_SIN_4};
  const float c = polynomial(for_cos, x * x), s = x * polynomial(for_sin, x * x);
  switch (whole % 4) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

OnCircle circle_at(float turns) {
  const float quarters = 4 * (turns - std::floor(turns)), nearest = std::floor(quarters + 0.5f);
  return circle_beside_quarter(static_cast<int>(nearest), quarters - nearest);
}

OnDisk disk_at(const glm::vec2& u) {
  const float x = 2 * u.x - 1 + 0x1p-24f, y = 2 * u.y - 1 + 0x1p-24f;
  if (std::fabs(x) > std::fabs(y)) {
    const OnCircle at = circle_beside_quarter(0, 0.5f * y / x);
    return {x * at.cos, x * at.sin, x};
  }
  const OnCircle at = circle_beside_quarter(0, y == 0 ? 0.0f : 0.5f * x / y);
  return {y * at.sin, y * at.cos, y};
}

OnCircle circle_at_part(std::uint32_t part) {
  const std::uint32_t whole = (part + (1u << 29)) >> 30;
  const auto beside = static_cast<std::int32_t>(part - (whole << 30));
  return circle_beside_quarter(static_cast<int>(whole), static_cast<float>(beside >> 5) * 0x1p-25f);
}

}  // namespace coppice::twins
