// Error-free transforms: the rounded sum or product of two floats, and what rounding left over. The two parts together
// are exact. two_sum: Knuth 1969, The Art of Computer Programming 2, 4.2.2; two_product: Dekker 1971, "A
// Floating-Point Technique for Extending the Available Precision", with the splitting of Veltkamp. No part may over- or
// underflow.
#ifndef COPPICE_LIB_ERROR_FREE
#define COPPICE_LIB_ERROR_FREE

vec2 two_sum(float a, float b) {
  precise float sum = a + b;
  precise float b_rounded = sum - a;
  precise float a_rounded = sum - b_rounded;
  precise float rest = (a - a_rounded) + (b - b_rounded);
  return vec2(sum, rest);
}

// Two halves of 12 bits, so that products of halves are exact.
vec2 split(float a) {
  precise float shifted = 4097.0 * a;
  precise float high = shifted - (shifted - a);
  precise float low = a - high;
  return vec2(high, low);
}

vec2 two_product(float a, float b) {
  precise float product = a * b;
  vec2 x = split(a), y = split(b);
  precise float rest = ((x.x * y.x - product) + x.x * y.y + x.y * y.x) + x.y * y.y;
  return vec2(product, rest);
}

// a * b - c * d, off by at most 3 * 2^-24 of itself however much cancels: so never of the wrong sign, and 0 only if it
// is. The proof is in docs/numerics.md, "Triangle test".
float product_difference(float a, float b, float c, float d) {
  vec2 p = two_product(a, b), q = two_product(c, d);
  precise float difference = (p.x - q.x) + (p.y - q.y);
  return difference;
}

#endif
