#include <cmath>
#include <limits>
#include <utility>

#include "interface/trace.h"
#include "twins/leave_surface.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": PCG.
class RandomWords {
 public:
  explicit RandomWords(uint state) : state_(state) {}

  uint next() {
    state_ = state_ * 747796405u + 2891336453u;
    const uint word = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return (word >> 22) ^ word;
  }

  // In [-1, 1).
  float next_signed() { return static_cast<float>(static_cast<std::int32_t>(next()) >> 8) / 8388608.0f; }

 private:
  uint state_;
};

std::pair<float, float> disk_point(RandomWords& random) {
  for (int tries = 0; tries < 8; ++tries) {
    const float x = random.next_signed(), y = random.next_signed();
    if (x * x + y * y < 1) return {x, y};
  }
  return {0, 0};
}

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
vec3 lift_to_hemisphere(std::pair<float, float> disk, const vec3& n) {
  const auto [x, y] = disk;
  const float side = n.z < 0 ? -1.0f : 1.0f;
  const float a = -1.0f / (side + n.z);
  const float b = n.x * n.y * a;
  const vec3 tangent(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
  const vec3 bitangent(b, side + n.y * n.y * a, -n.y);
  const float height = std::sqrt(std::fmax(1.0f - (x * x + y * y), 0.0f));
  return tangent * x + bitangent * y + n * height;
}

}  // namespace

void bounce_rays(const BounceRaysArgs& args) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (uint i = 0; i < args.ray_count; ++i) {
    args.bounced_hits[i] = {infinity, NO_TRIANGLE, 0, 0};
    args.bounced[i] = {vec3(0), 0, vec3(0), infinity};
    const Hit hit = args.hits[i];
    if (hit.triangle == NO_TRIANGLE) continue;
    const Triangle& triangle = args.triangles[hit.triangle];
    vec3 normal = unit_normal(triangle);
    if (dot_product(normal, unit_vector(args.rays[i].direction)) > 0) normal = -normal;
    RandomWords random(i ^ (args.seed * 0x9e3779b9u));
    random.next();
    args.bounced[i].origin = leave_surface(triangle, hit, normal);
    args.bounced[i].direction = lift_to_hemisphere(disk_point(random), normal);
  }
}

}  // namespace coppice::twins
