// What rays meet that hit nothing: ambient light, or a map of the radiance from every direction.
#ifndef COPPICE_INTERFACE_ENVIRONMENT_H
#define COPPICE_INTERFACE_ENVIRONMENT_H
#include "types.h"
INTERFACE_BEGIN

// The map is a square of side * side texels, onto which the sphere is folded by way of an octahedron
// (Engelhardt and Dachsbacher 2008, "Octahedron Environment Maps"): the direction (x, y, z) divided by |x| +
// |y| + |z| is at (x, z), from -1 to 1, where y is not negative, else at ((1 - |z|) sign(x), (1 - |x|)
// sign(z)), the sign of 0 being positive. Column and row rise with the first and the second. A place p on the
// octahedron has the solid angle |p|^-3 for each unit of area of the square, whose area is 4. Radiance is
// bilinear between the centres of texels, and goes on beyond an edge mirrored at the middle of that edge,
// which is the same place of the octahedron.
//
// A direction is chosen by integers: a row by its share of 2^24, then a column by its share of the row's
// 2^24, then a place uniform in the texel. So its density by solid angle is
//   row share * column share * 2^-48 * side^2 / 4 * |p|^3.
//
// Entry 0 of an array of this struct has as radiance the ambient light, and as end the side of the map, a
// power of two; 0: there is none, and no other entry.
//
// Entry 1 + side * y + x is a texel: its radiance, and the end of its share of the row, shares cumulated
// along the row. Entry 1 + side * side + y is a row: the end of its share, cumulated, and as x of radiance
// the probability that the environment is chosen among the lights, times the row's share * 2^-48 * side^2 /
// 4. The ends of the last row, and of the last texel of each row that has a share, are 2^24.
struct Surrounding {
  vec3 radiance;
  uint end;
};

INTERFACE_BUFFER(SurroundingBuffer, Surrounding, 16)

const uint ENVIRONMENT_RANGE = 0x1000000u;
const uint ENVIRONMENT_LEAST_SIDE = 16u, ENVIRONMENT_MOST_SIDE = 2048u;

INTERFACE_END
#endif
