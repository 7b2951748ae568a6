#include "scene/keyframes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace coppice {
namespace {

glm::dquat unit_quaternion(std::span<const double> q) {
  return glm::normalize(glm::dquat(q[3], q[0], q[1], q[2]));  // 0 becomes the identity
}

// Files round them: of (0, 0, 0.707, 0.707) the angle between two would be wrong.
void slerp(std::span<const double> a, std::span<const double> b, double part, std::span<double> result) {
  const glm::dquat turn = glm::slerp(unit_quaternion(a), unit_quaternion(b), part);
  result[0] = turn.x;
  result[1] = turn.y;
  result[2] = turn.z;
  result[3] = turn.w;
}

void normalise(std::span<double> quaternion) {
  double square = 0;
  for (const double x : quaternion) square += x * x;
  if (!(square > 0)) {
    std::fill(quaternion.begin(), quaternion.end(), 0.0);
    quaternion[3] = 1;
    return;
  }
  for (double& x : quaternion) x /= std::sqrt(square);
}

}  // namespace

void sample(const Keyframes& keyframes, double seconds, std::span<double> result) {
  const std::vector<double>& times = keyframes.times;
  const std::size_t width = keyframes.width, count = times.size();
  const bool is_cubic = keyframes.interpolation == Interpolation::cubic;
  const auto value = [&](std::size_t key, std::size_t part) {
    return std::span<const double>(keyframes.values)
        .subspan((is_cubic ? 3 * key + part : key) * width, width);
  };
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
  const std::size_t key = after == 0 ? 0 : after - 1;
  const std::span<const double> from = value(key, 1);
  if (after == 0 || after == count || keyframes.interpolation == Interpolation::step) {
    std::copy(from.begin(), from.end(), result.begin());
  } else {
    const double length = times[after] - times[key], t = (seconds - times[key]) / length;
    const std::span<const double> to = value(after, 1);
    if (is_cubic) {
      const std::span<const double> leaving = value(key, 2), coming = value(after, 0);
      const double t2 = t * t, t3 = t2 * t;
      for (std::size_t c = 0; c < width; ++c) {
        result[c] = (2 * t3 - 3 * t2 + 1) * from[c] + length * (t3 - 2 * t2 + t) * leaving[c] +
                    (3 * t2 - 2 * t3) * to[c] + length * (t3 - t2) * coming[c];
      }
    } else if (keyframes.is_rotation) {
      slerp(from, to, t, result);
    } else {
      for (std::size_t c = 0; c < width; ++c) result[c] = from[c] + (to[c] - from[c]) * t;
    }
  }
  if (keyframes.is_rotation) normalise(result.first(4));
}

void smooth(Keyframes& keyframes) {
  const std::size_t count = keyframes.times.size(), width = keyframes.width;
  std::vector<double> values;
  values.reserve(3 * keyframes.values.size());
  for (std::size_t key = 0; key < count; ++key) {
    const std::size_t before = key == 0 ? 0 : key - 1, after = std::min(key + 1, count - 1);
    const double length = keyframes.times[after] - keyframes.times[before];
    std::vector<double> tangent(width, 0.0);
    for (std::size_t c = 0; c < width && length > 0; ++c) {
      tangent[c] = (keyframes.values[after * width + c] - keyframes.values[before * width + c]) / length;
    }
    values.insert(values.end(), tangent.begin(), tangent.end());
    values.insert(values.end(), &keyframes.values[key * width], &keyframes.values[key * width] + width);
    values.insert(values.end(), tangent.begin(), tangent.end());
  }
  keyframes.values = std::move(values);
  keyframes.interpolation = Interpolation::cubic;
}

}  // namespace coppice
