// The fog of interface/fog.h. Include lib/exact_vector.glsl before.
#ifndef COPPICE_LIB_FOG
#define COPPICE_LIB_FOG
#include "interface/fog.h"
#include "lib/exponential.glsl"
#include "lib/length.glsl"

struct Fog {
  vec3 box_min, box_max, albedo;
  float density, anisotropy;
};

Fog fog_of(SurroundingBuffer at) {
  uint side = at.at[0].end, first = 1u + side * (side + 1u);
  Surrounding least = at.at[first], greatest = at.at[first + 1u];
  return Fog(least.radiance, greatest.radiance, at.at[first + 2u].radiance, uintBitsToFloat(least.end),
             uintBitsToFloat(greatest.end));
}

// Where a ray enters and leaves the fog before t_max, in units of its direction; it is nowhere in it where the second is
// not above the first. A direction whose component is below 2^-100 does not leave through these sides.
vec2 reach_of_fog(Fog fog, vec3 origin, vec3 direction, float t_max) {
  float enters = 0.0, leaves = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(direction[axis]) < 7.88860905e-31) {
      if (origin[axis] < fog.box_min[axis] || origin[axis] > fog.box_max[axis]) leaves = 0.0;
      continue;
    }
    precise float least = (fog.box_min[axis] - origin[axis]) / direction[axis];
    precise float greatest = (fog.box_max[axis] - origin[axis]) / direction[axis];
    enters = max(enters, min(least, greatest));
    leaves = min(leaves, max(least, greatest));
  }
  return vec2(enters, leaves);
}

// Optical depth of the way between the two; 0 where there is none.
float fog_depth(Fog fog, vec3 direction, vec2 reach) {
  if (!(reach.y > reach.x)) return 0.0;
  precise float depth = fog.density * ((reach.y - reach.x) * length_of(direction));
  return depth;
}

// The part of light that comes through on the way to t_max.
float fog_transmittance(Fog fog, vec3 origin, vec3 direction, float t_max) {
  return exp_minus(fog_depth(fog, direction, reach_of_fog(fog, origin, direction, t_max)));
}

// By solid angle, of light that goes on at an angle of this cosine to where it came from.
float fog_phase(float anisotropy, float cosine) {
  precise float base = 1.0 + anisotropy * anisotropy - 2.0 * anisotropy * cosine;
  precise float phase = ONE_BY_4PI * (1.0 - anisotropy * anisotropy) / (base * sqrt(base));
  return phase;
}

#endif
