#include <numbers>

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

struct OnCircle {
  float cosine, sine;
};

// Of a part of a turn of 2^32: Taylor's polynomials around the nearest quarter.
OnCircle on_circle(uint turn) {
  const uint quarter = (turn + (1u << 29)) >> 30;
  const auto beside = static_cast<std::int32_t>(turn - (quarter << 30));
  const float x = static_cast<float>(beside >> 5) * static_cast<float>(std::numbers::pi / 4 * 0x1p-24);
  const float xx = x * x;
  const float cosine = 1.0f + xx * (-0.5f + xx * (1.0f / 24 + xx * (-1.0f / 720)));
  const float sine = x + x * xx * (-1.0f / 6 + xx * (1.0f / 120 + xx * (-1.0f / 5040)));
  switch (quarter % 4) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

// a b + c d, each operation rounded.
float sum_of_products(float a, float b, float c, float d) { return flushed(flushed(a * b) + flushed(c * d)); }

}  // namespace

void move_instances(const MoveInstancesArgs& args) {
  const uint turn = args.turn[0];
  for (uint i = 0; i < args.instance_count; ++i) {
    Affine moved(args.rest[i]);
    const uint laps = 1 + pcg(i ^ (args.seed * 0x9e3779b9u)) / (1u << 30);
    const OnCircle tumble = on_circle(2 * laps * turn), orbit = on_circle(laps * turn);
    for (auto& row : moved.at) {
      const float y = row[1], z = row[2];
      row[1] = sum_of_products(tumble.cosine, y, tumble.sine, z);
      row[2] = sum_of_products(tumble.cosine, z, -tumble.sine, y);
    }
    for (int column = 0; column < 4; ++column) {
      float &x = moved.at[0][column], &z = moved.at[2][column];
      const float old_x = x;
      x = sum_of_products(orbit.cosine, old_x, -orbit.sine, z);
      z = sum_of_products(orbit.sine, old_x, orbit.cosine, z);
    }
    const auto& at = moved.at;
    args.transforms[i] = {{at[0][0], at[0][1], at[0][2]}, at[0][3], {at[1][0], at[1][1], at[1][2]}, at[1][3],
                          {at[2][0], at[2][1], at[2][2]}, at[2][3]};
  }
}

}  // namespace coppice::twins
