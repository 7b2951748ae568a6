#include "analysis/exact_walk.h"

#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "builders/leaves.h"

namespace coppice {
namespace {

using glm::dvec3;

// A number and a bound of its error.
struct Bounded {
  double value, error;
};

dvec3 sums_of_products(const dvec3& a, const dvec3& b) {
  const dvec3 x = glm::abs(a), y = glm::abs(b);
  return {x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x};
}

// d . (a x b), where each component of the three was rounded at most once. A term d_i a_j b_k of the sum is
// then rounded at most 8 times: 3 in the components, 2 as a product, 1 in the difference, 2 in the sum (N. J.
// Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 3.1). 16 leave room for the
// rounding of the bound itself. Differences and products of three or four floats neither overflow nor
// underflow in double.
Bounded triple_product(const dvec3& d, const dvec3& a, const dvec3& b) {
  return {glm::dot(d, glm::cross(a, b)),
          16 * ROUNDING_OF_DOUBLE * glm::dot(glm::abs(d), sums_of_products(a, b))};
}

int sure_sign(const Bounded& x) { return x.value > x.error ? 1 : x.value < -x.error ? -1 : 0; }

enum class Verdict { MISSES, MEETS, UNSURE };

// On which side of the three edges the line passes (Platis and Theoharis 2003).
Verdict tried_in_double(const ExactLine& line, const dvec3& a, const dvec3& b, const dvec3& c) {
  const int beside_bc = sure_sign(triple_product(line.direction, b, c));
  const int beside_ca = sure_sign(triple_product(line.direction, c, a));
  const int beside_ab = sure_sign(triple_product(line.direction, a, b));
  if (std::min({beside_bc, beside_ca, beside_ab}) < 0 && std::max({beside_bc, beside_ca, beside_ab}) > 0) {
    return Verdict::MISSES;
  }
  return beside_bc != 0 && beside_bc == beside_ca && beside_ca == beside_ab ? Verdict::MEETS
                                                                            : Verdict::UNSURE;
}

// The t of the triangle's plane, or an interval without end where it is not known well.
Interval distance_in_double(const ExactLine& line, const Triangle& triangle, const dvec3& a) {
  const dvec3 to_b = dvec3(triangle.b) - dvec3(triangle.a), to_c = dvec3(triangle.c) - dvec3(triangle.a);
  const Bounded slope = triple_product(line.direction, to_b, to_c);
  if (sure_sign(slope) == 0) return {};
  const Bounded height = triple_product(a, to_b, to_c);
  const double t = height.value / slope.value;
  const double error =
      1.01 * (height.error + std::abs(t) * slope.error) / (std::abs(slope.value) - slope.error) +
      2 * ROUNDING_OF_DOUBLE * std::abs(t);
  if (!(error <= 0x1p-40 * std::abs(t))) return {};
  return {t - error, t + error};
}

}  // namespace

ExactLine::ExactLine(const Ray& given) : ray(given), origin(given.origin) {
  ray.direction = direction_that_counts(given);
  direction = ray.direction;
  reciprocal = 1.0 / direction;
}

Interval ExactLine::clip(const vec3& box_min, const vec3& box_max) const {
  Interval inside;
  for (int axis = 0; axis < 3; ++axis) {
    const double room = BOX_ROOM * std::max(std::abs(double{box_min[axis]}), std::abs(double{box_max[axis]}));
    const double low = box_min[axis] - origin[axis] - room;
    const double high = box_max[axis] - origin[axis] + room;
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return {1.0, 0.0};
      continue;
    }
    // Two differences, a reciprocal and a product: four roundings, and for the differences `room` covers
    // what cancels, except of a corner at 0, whose difference is exact.
    double t0 = low * reciprocal[axis], t1 = high * reciprocal[axis];
    if (t0 > t1) std::swap(t0, t1);
    inside.low = std::max(inside.low, t0 - 8 * ROUNDING_OF_DOUBLE * std::abs(t0));
    inside.high = std::min(inside.high, t1 + 8 * ROUNDING_OF_DOUBLE * std::abs(t1));
  }
  return inside;
}

std::optional<Candidate> find_candidate(const ExactLine& line, std::span<const Triangle> triangles,
                                        std::uint32_t index, double exact_limit) {
  const Triangle& triangle = triangles[index];
  if (!is_active(triangle)) return std::nullopt;
  const dvec3 a = dvec3(triangle.a) - line.origin;
  const Verdict verdict =
      tried_in_double(line, a, dvec3(triangle.b) - line.origin, dvec3(triangle.c) - line.origin);
  if (verdict == Verdict::MISSES) return std::nullopt;
  const double t_min = line.ray.t_min, t_max = line.ray.t_max;
  const Interval t = distance_in_double(line, triangle, a);
  if (verdict == Verdict::UNSURE && t.low > exact_limit) return std::nullopt;
  if (verdict == Verdict::MEETS) {
    if (t.low > t_max || t.high < t_min) return Candidate{index, t, false};
    if (t.low >= t_min && t.high <= t_max && std::isfinite(t.low)) return Candidate{index, t, true};
  }
  const ExactMeeting meeting = exact_meeting(triangle, line.ray);
  if (!meeting.meets) return std::nullopt;
  const double error = 2 * ROUNDING_OF_DOUBLE * std::abs(meeting.t);
  return Candidate{index, {meeting.t - error, meeting.t + error}, meeting.in_range};
}

void ClosestCandidate::offer(const Candidate& candidate) {
  if (!candidate.in_range) return;
  if (!best_ || candidate.t.high < best_->t.low) {
    best_ = candidate;
    return;
  }
  if (candidate.t.low > best_->t.high) return;
  const Triangle& triangle = triangles_[candidate.triangle];
  const Triangle& other = triangles_[best_->triangle];
  // Copies of one triangle are common enough to be told apart cheaply.
  const bool are_copies = std::memcmp(&triangle, &other, sizeof(Triangle)) == 0;
  const int order = are_copies ? 0 : compare_distances(triangle, other, line_.ray);
  if (order < 0 || (order == 0 && candidate.triangle < best_->triangle)) best_ = candidate;
}

}  // namespace coppice
