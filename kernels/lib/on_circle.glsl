// Sine and cosine of a part of a turn of 2^32, with multiplications and additions only, so that every device computes
// the same bits. Taylor's polynomials on an eighth of a turn to either side; errors are below 2^-20.
#ifndef COPPICE_LIB_ON_CIRCLE
#define COPPICE_LIB_ON_CIRCLE

// (cosine, sine)
vec2 on_circle(uint turn) {
  uint quarter = (turn + 0x20000000u) >> 30;
  int beside = int(turn - (quarter << 30));                      // from -2^29 to 2^29
  precise float x = float(beside >> 5) * 4.68133798e-08;          // exact, times pi / 4 / 2^24
  precise float xx = x * x;
  precise float cosine = 1.0 + xx * (-0.5 + xx * (4.16666679e-2 + xx * -1.38888892e-3));
  precise float sine = x + x * xx * (-1.66666672e-1 + xx * (8.33333377e-3 + xx * -1.98412701e-4));
  vec2 point = (quarter & 1u) == 0u ? vec2(cosine, sine) : vec2(-sine, cosine);
  return (quarter & 2u) == 0u ? point : -point;
}

#endif
