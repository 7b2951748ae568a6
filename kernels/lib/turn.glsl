// (cos, sin) of an angle in turns, by add and multiply alone: the same bits on every device. To 3e-7, for turns of up to
// 1e3.
#ifndef COPPICE_LIB_TURN
#define COPPICE_LIB_TURN

vec2 turn(float turns) {
  precise float quarters = 4.0 * (turns - floor(turns));
  precise float whole = floor(quarters + 0.5);
  precise float x = quarters - whole;
  precise float y = x * x;
  precise float c = TURN_COS_0 + y * (TURN_COS_1 + y * (TURN_COS_2 + y * (TURN_COS_3 + y * TURN_COS_4)));
  precise float s = x * (TURN_SIN_0 + y * (TURN_SIN_1 + y * (TURN_SIN_2 + y * (TURN_SIN_3 + y * TURN_SIN_4))));
  uint quadrant = uint(whole) & 3u;
  vec2 by = (quadrant & 1u) == 0u ? vec2(c, s) : vec2(-s, c);
  return quadrant < 2u ? by : -by;
}

#endif
