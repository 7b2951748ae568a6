#include <cmath>
#include <numbers>

#include "interface/instances.h"

namespace coppice::twins {

namespace {

// PCG, as in bounce_rays.
class SwarmNumbers {
 public:
  explicit SwarmNumbers(uint state) : state_(state) { word(); }

  uint word() {
    state_ = state_ * 747796405u + 2891336453u;
    const uint mixed = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return (mixed >> 22) ^ mixed;
  }
  float part() { return static_cast<float>(word() >> 8) / 0x1p24f; }  // [0, 1)
  float signed_part() {
    return static_cast<float>(static_cast<std::int32_t>(word()) >> 8) / 0x1p23f;
  }  // [-1, 1)

 private:
  uint state_;
};

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

}  // namespace

void move_instances(const MoveInstancesArgs& args) {
  const float swarm = std::ldexp(1.0f, static_cast<int>(args.exponent) - 127);
  for (uint i = 0; i < args.instance_count; ++i) {
    SwarmNumbers random(i ^ (args.seed * 0x9e3779b9u));
    const float radius = swarm * (0.125f + 0.875f * random.part());
    const float height = swarm * 0.5f * random.signed_part();
    const float size = 0.25f + 0.75f * random.part();
    const uint laps = 1 + random.word() / (1u << 30);
    const OnCircle orbit = on_circle(random.word() + laps * args.turn);
    const OnCircle tumble = on_circle(random.word() + 2 * laps * args.turn);
    const float mirrored = i % 2 == 0 ? size : -size;
    args.transforms[i] = {
        {orbit.cosine * mirrored, orbit.sine * tumble.sine * size, orbit.sine * tumble.cosine * size},
        radius * orbit.cosine,
        {0, tumble.cosine * size, -tumble.sine * size},
        height,
        {-orbit.sine * mirrored, orbit.cosine * tumble.sine * size, orbit.cosine * tumble.cosine * size},
        radius * orbit.sine};
  }
}

}  // namespace coppice::twins
