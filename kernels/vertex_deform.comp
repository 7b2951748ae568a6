// In:  positions and the how.phase of a cycle. Out: the positions bent by one of the deformations of scene/motion.h, as
// q = (position - centre) / size becomes f(q) and goes back. Add, multiply, floor and integers only: the same bits on
// every device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/vertex.h"
#include "lib/subgroup_run.glsl"
#include "lib/turn.glsl"

layout(local_size_x = VERTEX_GROUP) in;
layout(push_constant, scalar) uniform Push { VertexDeformArgs args; };

DeformStep how;  // read once by main

vec3 load(uint vertex) {
  return vec3(args.source.at[3u * vertex], args.source.at[3u * vertex + 1u], args.source.at[3u * vertex + 2u]);
}

vec3 to_sizes(vec3 position) {
  precise vec3 q = (position - how.centre) * how.inverse_size;
  return q;
}

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": pcg3d. Each in [-1, 1).
vec3 piece_draws(uint piece) {
  uvec3 v = uvec3(piece, piece ^ 0x9e3779b9u, ~piece) * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  precise vec3 draws = vec3(v >> 8) * 1.1920928955078125e-7 - 1.0;
  return draws;
}

// The way of a point that is turned about the axis y.
vec3 turning_way(vec3 p, float turns) {
  vec2 by = turn(turns);
  precise float x = (by.x * p.x + by.y * p.z) - p.x;
  precise float z = (by.x * p.z - by.y * p.x) - p.z;
  return vec3(x, 0.0, z);
}

vec3 wave(vec3 q) {
  precise float across = 2.0 * q.x - how.phase, along = 3.0 * q.z + how.phase;
  precise float up = how.amount * (turn(across).y + 0.5 * turn(along).y);
  return vec3(0.0, up, 0.0);
}

vec3 twist(vec3 q) {
  precise float turns = how.amount * q.y * turn(how.phase).y;
  return turning_way(q, turns);
}

vec3 explode(vec3 q, uint vertex) {
  uint piece = vertex / how.piece_vertices;
  vec3 draws = piece_draws(piece), first = to_sizes(load(piece * how.piece_vertices));
  precise float away = 0.5 - 0.5 * turn(how.phase).x, tumble = 2.0 * away * draws.x, far = how.amount * away;
  precise vec3 arm = q - first;
  vec3 tumbling = turning_way(arm, tumble);
  precise vec3 way = (first + 0.5 * draws) * far + tumbling;
  return way;
}

vec3 swarm(vec3 q, uint vertex) {
  vec3 draws = piece_draws(vertex / how.piece_vertices);
  precise float rounds = 1.0 + floor(1.5 * (draws.y + 1.0));
  precise float turns = how.phase * rounds, at = how.phase + draws.z;
  vec3 way = turning_way(q, draws.x < 0.0 ? -turns : turns);
  precise float up = how.amount * turn(at).y;
  return vec3(way.x, up, way.z);
}

// From where it is at phase 0.
float swing(float at, float start) {
  precise float way = turn(at).y - turn(start).y;
  return way;
}

vec3 sway(vec3 q) {
  float height = max(q.y, 0.0);
  precise float bend = how.amount * height * height, across = how.phase + q.x, along = 2.0 * how.phase + q.z;
  precise float x = bend * swing(across, q.x), z = 0.5 * bend * swing(along, q.z);
  return vec3(x, 0.0, z);
}

vec3 way_of(vec3 q, uint vertex) {
  if (how.kind == DEFORM_WAVE) return wave(q);
  if (how.kind == DEFORM_TWIST) return twist(q);
  if (how.kind == DEFORM_EXPLODE) return explode(q, vertex);
  if (how.kind == DEFORM_SWARM) return swarm(q, vertex);
  return sway(q);
}

vec3 moved(vec3 position, vec3 way) {
  precise vec3 place = position + way * how.size;
  return place;
}

void main() {
  how = args.how.at[0];
  Run run = subgroup_run(gl_WorkGroupID.x * VERTEX_TILE, VERTICES_PER_INVOCATION, args.vertex_count);
  [[dont_unroll]] for (uint i = run.first; i < run.last; i += LANES) {
    vec3 position = load(i);
    vec3 place = moved(position, way_of(to_sizes(position), i));
    args.vertices.at[3u * i] = place.x;
    args.vertices.at[3u * i + 1u] = place.y;
    args.vertices.at[3u * i + 2u] = place.z;
  }
}
