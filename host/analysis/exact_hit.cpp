#include "analysis/exact_hit.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <utility>

#include "analysis/exact_walk.h"
#include "builders/leaves.h"

namespace coppice {
namespace {

// A finite float as mantissa * 2^exponent.
struct Binary {
  explicit Binary(float x) {
    int power = 0;
    mantissa = static_cast<long>(std::ldexp(std::frexp(x, &power), 24));
    exponent = power - 24;
  }
  long mantissa;
  long exponent;
};

struct IntegerVector {
  mpz_class x, y, z;
};

IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

mpz_class dot(const IntegerVector& a, const IntegerVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

mpz_class shifted(const mpz_class& x, long bits) {
  mpz_class result;
  if (bits >= 0) {
    mpz_mul_2exp(result.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
  } else {
    mpz_tdiv_q_2exp(result.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(-bits));
  }
  return result;
}

// The unit 2^unit_exponent of which all of the coordinates are multiples; 0 where all are 0.
long common_exponent(std::span<const vec3> vectors) {
  bool is_first = true;
  long least = 0;
  for (const vec3& v : vectors) {
    for (int axis = 0; axis < 3; ++axis) {
      if (v[axis] == 0.0f) continue;
      const long exponent = Binary(v[axis]).exponent;
      least = is_first ? exponent : std::min(least, exponent);
      is_first = false;
    }
  }
  return least;
}

IntegerVector in_units(const vec3& v, long unit_exponent) {
  const auto scaled = [&](float x) {
    if (x == 0.0f) return mpz_class(0);
    const Binary binary(x);
    return shifted(mpz_class(binary.mantissa), binary.exponent - unit_exponent);
  };
  return {scaled(v.x), scaled(v.y), scaled(v.z)};
}

// numerator / denominator * 2^exponent, the denominator positive.
struct Fraction {
  // The given denominator may be negative; 0 makes no number.
  Fraction(mpz_class top, mpz_class bottom, long power)
      : numerator(std::move(top)), denominator(std::move(bottom)), exponent(power) {
    if (sgn(denominator) < 0) {
      numerator = -numerator;
      denominator = -denominator;
    }
  }
  mpz_class numerator, denominator;
  long exponent;
};

int compare(const Fraction& a, const Fraction& b) {
  const long least = std::min(a.exponent, b.exponent);
  const mpz_class left = shifted(a.numerator * b.denominator, a.exponent - least);
  const mpz_class right = shifted(b.numerator * a.denominator, b.exponent - least);
  return cmp(left, right) < 0 ? -1 : left == right ? 0 : 1;
}

// An infinite float compares as it should.
int compare(const Fraction& a, float b) {
  if (std::isinf(b)) return b > 0 ? -1 : 1;
  if (b == 0.0f) return sgn(a.numerator);
  const Binary binary(b);
  return compare(a, Fraction(binary.mantissa, 1, binary.exponent));
}

// Rounded to nearest: a quotient of 61 to 63 bits, its last bit set where a remainder is left.
double rounded(const Fraction& x) {
  if (sgn(x.numerator) == 0) return 0.0;
  const mpz_class size = abs(x.numerator);
  const auto bits_of = [](const mpz_class& n) { return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2)); };
  const long shift = 62 - (bits_of(size) - bits_of(x.denominator));
  const mpz_class dividend = shift >= 0 ? shifted(size, shift) : size;
  const mpz_class divisor = shift >= 0 ? x.denominator : shifted(x.denominator, -shift);
  mpz_class quotient, remainder;
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), dividend.get_mpz_t(), divisor.get_mpz_t());
  std::uint64_t word = mpz_get_ui(quotient.get_mpz_t());
  if (sgn(remainder) != 0) word |= 1;
  const double value = std::ldexp(static_cast<double>(word), static_cast<int>(x.exponent - shift));
  return sgn(x.numerator) < 0 ? -value : value;
}

// The line against the three edges, in integers. The ray's origin is the origin of all vectors.
class Meeting {
 public:
  // Both finite, and the direction without denormals.
  Meeting(const Triangle& triangle, const Ray& ray) {
    const long unit = common_exponent(std::array{triangle.a, triangle.b, triangle.c, ray.origin});
    const IntegerVector origin = in_units(ray.origin, unit);
    const IntegerVector direction = in_units(ray.direction, common_exponent(std::array{ray.direction}));
    const IntegerVector a = in_units(triangle.a, unit) - origin;
    const IntegerVector b = in_units(triangle.b, unit) - origin;
    const IntegerVector c = in_units(triangle.c, unit) - origin;
    beside_bc = dot(direction, cross(b, c));
    beside_ca = dot(direction, cross(c, a));
    beside_ab = dot(direction, cross(a, b));
    // Direction . normal, since the normal is the sum of the three cross products.
    slope = beside_bc + beside_ca + beside_ab;
  }

  // A slope of 0: no area, or in the plane.
  bool meets() const {
    const int sides[] = {sgn(beside_bc), sgn(beside_ca), sgn(beside_ab)};
    const bool all_left = std::ranges::all_of(sides, [](int side) { return side >= 0; });
    const bool all_right = std::ranges::all_of(sides, [](int side) { return side <= 0; });
    return sgn(slope) != 0 && (all_left || all_right);
  }
  bool on_border() const { return sgn(beside_bc) == 0 || sgn(beside_ca) == 0 || sgn(beside_ab) == 0; }

  // Only where it meets, so that all signs agree.
  double share_of(const mpz_class& beside) const { return rounded(Fraction(abs(beside), abs(slope), 0)); }

  mpz_class beside_bc, beside_ca, beside_ab, slope;
};

// The t of the plane of a triangle that the line meets.
Fraction plane_distance(const Triangle& triangle, const Ray& ray) {
  const long unit = common_exponent(std::array{triangle.a, triangle.b, triangle.c, ray.origin});
  const long direction_unit = common_exponent(std::array{ray.direction});
  const IntegerVector a = in_units(triangle.a, unit);
  const IntegerVector normal = cross(in_units(triangle.b, unit) - a, in_units(triangle.c, unit) - a);
  return Fraction(dot(a - in_units(ray.origin, unit), normal),
                  dot(in_units(ray.direction, direction_unit), normal), unit - direction_unit);
}

Ray that_counts(const Ray& ray) { return {ray.origin, ray.t_min, direction_that_counts(ray), ray.t_max}; }

}  // namespace

bool can_hit(const Ray& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(ray.origin[axis]) || !std::isfinite(ray.direction[axis])) return false;
  }
  return direction_that_counts(ray) != vec3(0) && ray.t_min <= ray.t_max;
}

vec3 direction_that_counts(const Ray& ray) {
  vec3 direction = ray.direction;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < FLT_MIN) direction[axis] = 0.0f;
  }
  return direction;
}

ExactMeeting exact_meeting(const Triangle& triangle, const Ray& ray) {
  if (!is_active(triangle) || !can_hit(ray)) return {};
  const Ray counted = that_counts(ray);
  const Meeting meeting(triangle, counted);
  if (!meeting.meets()) return {};
  const Fraction t = plane_distance(triangle, counted);
  return {.meets = true,
          .in_range = compare(t, ray.t_min) >= 0 && compare(t, ray.t_max) <= 0,
          .on_border = meeting.on_border(),
          .t = rounded(t),
          .u = meeting.share_of(meeting.beside_ca),
          .v = meeting.share_of(meeting.beside_ab)};
}

int compare_distances(const Triangle& first, const Triangle& second, const Ray& ray) {
  const Ray counted = that_counts(ray);
  return compare(plane_distance(first, counted), plane_distance(second, counted));
}

bool is_exactly_degenerate(const Triangle& triangle) {
  if (!is_active(triangle)) return false;
  const long unit = common_exponent(std::array{triangle.a, triangle.b, triangle.c});
  const IntegerVector a = in_units(triangle.a, unit);
  const IntegerVector normal = cross(in_units(triangle.b, unit) - a, in_units(triangle.c, unit) - a);
  return sgn(normal.x) == 0 && sgn(normal.y) == 0 && sgn(normal.z) == 0;
}

ExactHit closest_exact(std::span<const Node> nodes, std::span<const Triangle> triangles, const Ray& ray) {
  if (!can_hit(ray)) return {};
  const ExactLine line(ray);
  ClosestCandidate closest(line, triangles);
  std::vector<WalkEntry> stack;
  const auto limit = [&] { return closest.best() ? closest.best()->t.high : double{ray.t_max}; };
  walk_triangles(nodes, triangles, line, stack, limit, [&](std::uint32_t index) {
    if (const auto candidate = find_candidate(line, triangles, index, limit())) closest.offer(*candidate);
  });
  if (!closest.best()) return {};
  const std::uint32_t index = closest.best()->triangle;
  return {index, exact_meeting(triangles[index], ray)};
}

}  // namespace coppice
