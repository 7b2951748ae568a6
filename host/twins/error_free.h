#pragma once

#include <cmath>

namespace coppice::twins {

// Error-free transforms: the rounded value and what rounding left over, exactly, unless a part over- or
// underflows. The rest of a product comes from a fused multiply-add, where kernels split the factors (Dekker
// 1971).
struct Unrounded {
  float value, rest;
};

inline Unrounded exact_sum(float a, float b) {
  const float sum = a + b;
  const float b_rounded = sum - a;
  return {sum, (a - (sum - b_rounded)) + (b - b_rounded)};
}

inline Unrounded exact_product(float a, float b) {
  const float product = a * b;
  return {product, std::fma(a, b, -product)};
}

// a * b - c * d, off by at most 3 * 2^-24 of itself however much cancels.
inline float difference_of_products(float a, float b, float c, float d) {
  const Unrounded first = exact_product(a, b), second = exact_product(c, d);
  return (first.value - second.value) + (first.rest - second.rest);
}

}  // namespace coppice::twins
