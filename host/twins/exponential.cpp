#include "twins/exponential.h"

#include <cmath>

namespace coppice::twins {

namespace {

// Horner's rule, the constant term first.
template <int count>
float polynomial(float x, const float (&coefficients)[count]) {
  float sum = coefficients[count - 1];
  for (int i = count - 2; i >= 0; --i) sum = coefficients[i] + x * sum;
  return sum;
}

}  // namespace

float exp_minus(float x) {
  if (!(x < 87)) return 0;
  const float powers = std::floor(x * 1.44269502f + 0.5f);
  const float rest = (powers * 0.693359375f - x) - powers * 0.000212194442f;
  const float series =
      polynomial(rest, {1, 1, 1 / 2.0f, 1 / 6.0f, 1 / 24.0f, 1 / 120.0f, 1 / 720.0f, 1 / 5040.0f});
  return std::ldexp(series, -static_cast<int>(powers));
}

float one_minus_exp(float x) {
  if (!(x < 0.0625f)) return 1 - exp_minus(x);
  return x * (1 - x * (1 / 2.0f - x * (1 / 6.0f - x * (1 / 24.0f - x * (1 / 120.0f)))));
}

float minus_log(float y) {
  int exponent;
  float mantissa = 2 * std::frexp(y, &exponent);  // in [1, 2)
  --exponent;
  if (mantissa > 1.41421354f) {
    mantissa /= 2;
    ++exponent;
  }
  const float s = (mantissa - 1) / (mantissa + 1);
  const float series = polynomial(s * s, {1, 1 / 3.0f, 1 / 5.0f, 1 / 7.0f, 1 / 9.0f});
  return -(static_cast<float>(exponent) * 0.693147182f + 2 * s * series);
}

}  // namespace coppice::twins
