// e^-x and -ln y of additions, multiplications and one division, so that every device has the same digits: Cody and Waite
// 1980, "Software Manual for the Elementary Functions", with the terms of Taylor's series.
#ifndef COPPICE_LIB_EXPONENTIAL
#define COPPICE_LIB_EXPONENTIAL

const float EXP_ENDS = 87.0;  // from there on e^-x is 0 here
const float LN_2 = 0.693147182;

// e^-x of x from 0 on: 2^-n e^r, r = n ln 2 - x.
float exp_minus(float x) {
  if (!(x < EXP_ENDS)) return 0.0;
  precise float n = floor(x * 1.44269502 + 0.5);
  precise float r = (n * 0.693359375 - x) - n * 0.000212194442;  // ln 2 of two numbers, the first of nine bits
  precise float terms =
      1.0 + r * (1.0 + r * (0.5 + r * (0.166666672 + r * (0.0416666679 + r * (0.00833333377 + r * (0.00138888892 +
      r * 0.000198412701))))));
  precise float result = terms * uintBitsToFloat((127u - uint(n)) << 23);
  return result;
}

// 1 - e^-x of x from 0 on, also where it is small.
float one_minus_exp(float x) {
  if (!(x < 0.0625)) {
    precise float rest = 1.0 - exp_minus(x);
    return rest;
  }
  precise float small = x * (1.0 - x * (0.5 - x * (0.166666672 - x * (0.0416666679 - x * 0.00833333377))));
  return small;
}

// -ln y of y above 0, up to 1 and not denormal: y = 2^e m, m from the root of 1/2 to that of 2, and the series of the
// inverse hyperbolic tangent of s = (m - 1) / (m + 1).
float minus_log(float y) {
  uint bits = floatBitsToUint(y);
  int e = int(bits >> 23) - 127;
  float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
  if (m > 1.41421354) {
    m *= 0.5;
    ++e;
  }
  precise float s = (m - 1.0) / (m + 1.0);
  precise float z = s * s;
  precise float log_m = 2.0 * s * (1.0 + z * (0.333333343 + z * (0.2 + z * (0.142857149 + z * 0.111111112))));
  precise float log_y = float(e) * LN_2 + log_m;
  return -log_y;
}

#endif
