#include <algorithm>
#include <cmath>

#include "interface/vertex.h"
#include "twins/circle.h"

namespace coppice::twins {

namespace {

vec3 turned_way(const vec3& p, float turns) {
  const OnCircle at = circle_at(turns);
  return {at.cos * p.x + at.sin * p.z - p.x, 0, at.cos * p.z - at.sin * p.x - p.z};
}

// pcg3d, see piece_draws in scene/motion.cpp.
vec3 draws_of(uint piece) {
  uint x = piece * 1664525 + 1013904223, y = (piece ^ 0x9e3779b9) * 1664525 + 1013904223;
  uint z = ~piece * 1664525 + 1013904223;
  for (int turn = 0; turn < 2; ++turn) {
    x += y * z;
    y += z * x;
    z += x * y;
    if (turn == 0) x ^= x >> 16, y ^= y >> 16, z ^= z >> 16;
  }
  const auto draw = [](uint word) { return static_cast<float>(word >> 8) / 8388608.0f - 1; };
  return {draw(x), draw(y), draw(z)};
}

vec3 position_of(const VertexDeformArgs& args, uint vertex) {
  const float* const p = &args.source[std::size_t{3} * vertex];
  return {p[0], p[1], p[2]};
}

vec3 way_of(const VertexDeformArgs& args, uint vertex) {
  const DeformStep& how = args.how[0];
  const auto in_sizes = [&](uint v) { return (position_of(args, v) - how.centre) * how.inverse_size; };
  const vec3 q = in_sizes(vertex);
  const uint piece = vertex / how.piece_vertices;
  switch (how.kind) {
    case DEFORM_WAVE: {
      const float both = circle_at(2 * q.x - how.phase).sin + 0.5f * circle_at(3 * q.z + how.phase).sin;
      return {0, how.amount * both, 0};
    }
    case DEFORM_TWIST:
      return turned_way(q, how.amount * q.y * circle_at(how.phase).sin);
    case DEFORM_EXPLODE: {
      const vec3 draws = draws_of(piece), first = in_sizes(piece * how.piece_vertices);
      const float away = 0.5f - 0.5f * circle_at(how.phase).cos, far = how.amount * away;
      return (first + 0.5f * draws) * far + turned_way(q - first, 2 * away * draws.x);
    }
    case DEFORM_SWARM: {
      const vec3 draws = draws_of(piece);
      const float turns = how.phase * (1 + std::floor(1.5f * (draws.y + 1)));
      vec3 way = turned_way(q, draws.x < 0 ? -turns : turns);
      way.y = how.amount * circle_at(how.phase + draws.z).sin;
      return way;
    }
    default: {
      const float height = std::max(q.y, 0.0f), bend = how.amount * height * height;
      const auto swing = [](float at, float start) { return circle_at(at).sin - circle_at(start).sin; };
      return {bend * swing(how.phase + q.x, q.x), 0, 0.5f * bend * swing(2 * how.phase + q.z, q.z)};
    }
  }
}

}  // namespace

void vertex_deform(const VertexDeformArgs& args) {
  for (uint i = 0; i < args.vertex_count; ++i) {
    const vec3 place = position_of(args, i) + way_of(args, i) * args.how[0].size;
    for (int axis = 0; axis < 3; ++axis) args.vertices[std::size_t{3} * i + axis] = place[axis];
  }
}

}  // namespace coppice::twins
