#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace coppice {

// Scenes made by the program. Each is a pure function of its arguments, with the same triangles on every
// machine.

// "grove": a coppiced wood, the built-in default. Stools of branching shoots, rocks and felled logs on
// rolling ground; about 200,000 triangles, with a camera and a light of its own.
Scene make_grove();

// "scatter:N": exactly `triangle_count` unconnected triangles for benchmarks, in clusters whose sizes span
// several orders of magnitude, some long and thin, some large.
Scene make_scatter(std::uint32_t triangle_count, std::uint64_t seed = 1);

// "terrain:N": one connected height field of exactly `triangle_count` triangles, two per cell; the last row
// of cells may be incomplete.
Scene make_terrain(std::uint32_t triangle_count);

// "moving:N": exactly `triangle_count` triangles, all of which move: water in waves, a column that twists, a
// shell that explodes and comes together, a swarm around the column. A cycle takes four seconds.
Scene make_moving(std::uint32_t triangle_count);

}  // namespace coppice
