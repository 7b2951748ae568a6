// (cos, sin) by add and multiply alone: the same bits on every device.
#ifndef COPPICE_LIB_TURN
#define COPPICE_LIB_TURN
#include "interface/circle.h"

// Of so many whole quarter turns and x more, from -1/2 to 1/2.
vec2 quarter_turns(uint whole, float x) {
  precise float y = x * x;
  precise float c = TURN_COS_0 + y * (TURN_COS_1 + y * (TURN_COS_2 + y * (TURN_COS_3 + y * TURN_COS_4)));
  precise float s = x * (TURN_SIN_0 + y * (TURN_SIN_1 + y * (TURN_SIN_2 + y * (TURN_SIN_3 + y * TURN_SIN_4))));
  vec2 by = (whole & 1u) == 0u ? vec2(c, s) : vec2(-s, c);
  return (whole & 2u) == 0u ? by : -by;
}

// Of an angle in turns, to 3e-7 for turns of up to 1e3.
vec2 turn(float turns) {
  precise float quarters = 4.0 * (turns - floor(turns));
  precise float whole = floor(quarters + 0.5);
  precise float x = quarters - whole;
  return quarter_turns(uint(whole), x);
}

// Of a part of a turn of 2^32.
vec2 part_of_turn(uint part) {
  uint whole = (part + 0x20000000u) >> 30;
  int beside = int(part - (whole << 30));                  // from -2^29 to 2^29
  precise float x = float(beside >> 5) * 2.98023224e-08;  // exact: 2^-25
  return quarter_turns(whole, x);
}

#endif
