#include "twins/circle.h"
#include "twins/finite.h"
#include "twins/instance.h"

namespace coppice::twins {

namespace {

// PCG, as in bounce_rays.
uint pcg(uint counter) {
  const uint state = counter * 747796405u + 2891336453u;
  const uint mixed = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (mixed >> 22) ^ mixed;
}

// a b + c d, each operation rounded.
float sum_of_products(float a, float b, float c, float d) { return flushed(flushed(a * b) + flushed(c * d)); }

}  // namespace

void move_instances(const MoveInstancesArgs& args) {
  const uint turn = args.turn[0];
  for (uint i = 0; i < args.instance_count; ++i) {
    Affine moved(args.rest[i]);
    const uint laps = 1 + pcg(i ^ (args.seed * 0x9e3779b9u)) / (1u << 30);
    const OnCircle tumble = circle_at_part(2 * laps * turn), orbit = circle_at_part(laps * turn);
    for (auto& row : moved.at) {
      const float y = row[1], z = row[2];
      row[1] = sum_of_products(tumble.cos, y, tumble.sin, z);
      row[2] = sum_of_products(tumble.cos, z, -tumble.sin, y);
    }
    for (int column = 0; column < 4; ++column) {
      float &x = moved.at[0][column], &z = moved.at[2][column];
      const float old_x = x;
      x = sum_of_products(orbit.cos, old_x, -orbit.sin, z);
      z = sum_of_products(orbit.sin, old_x, orbit.cos, z);
    }
    const auto& at = moved.at;
    args.transforms[i] = {{at[0][0], at[0][1], at[0][2]}, at[0][3], {at[1][0], at[1][1], at[1][2]}, at[1][3],
                          {at[2][0], at[2][1], at[2][2]}, at[2][3]};
  }
}

}  // namespace coppice::twins
