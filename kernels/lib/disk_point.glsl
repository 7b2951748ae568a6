// A point of the unit disk, evenly: the concentric map of Shirley and Chiu 1997, "A Low Distortion Map Between Disk and
// Square". Without transcendental functions, but it divides.
#ifndef COPPICE_LIB_DISK_POINT
#define COPPICE_LIB_DISK_POINT
#include "lib/turn.glsl"

// Its coordinates, and how far it is from the centre, of either sign. For u in multiples of 2^-24 it is never quite at
// the border.
vec3 disk_point(vec2 u) {
  precise vec2 place = 2.0 * u - 1.0 + 5.9604644775390625e-8;  // to the middle: an odd multiple of 2^-24
  bool across = abs(place.x) > abs(place.y);
  float radius = across ? place.x : place.y;
  float other = across ? place.y : place.x;
  precise float angle = radius == 0.0 ? 0.0 : 0.5 * other / radius;
  vec2 turned = quarter_turns(0u, angle);
  precise vec2 disk = radius * (across ? turned : turned.yx);
  return vec3(disk, radius);
}

#endif
