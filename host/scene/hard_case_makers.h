#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/random.h"
#include "scene/scene.h"

// The functions behind the table in hard_cases.cpp; hard_cases.h is what the rest of the program includes.
// What each one makes, and why that is hard, stands at its definition.
namespace coppice::hard {

using Maker = Scene(std::uint32_t triangle_count, std::uint64_t seed);

// hard_cases_ties.cpp: distances or Morton codes that are all the same.
Maker coincident, coincident_and_random, nested, nested_shells, one_cell, stadium;
// hard_cases_gaps.cpp: chains of nearest neighbours.
Maker shrinking_gaps, shrinking_gaps_plane, shrinking_gaps_spiral;
Maker geometric_gaps, geometric_gaps_plane, geometric_gaps_spiral;
// hard_cases_range.cpp: coordinates at the ends of the range of float, and beyond.
Maker non_finite, all_non_finite, huge, large, tiny, mixed_scales, far, farther, negative_zero;
// hard_cases_scales.cpp: a detail in a scene whose box is far larger.
Maker detail_on_ground, detail_in_dome, stray_corner, detail_in_detail;
// hard_cases_shapes.cpp: triangles of odd shape, odd index buffers.
Maker planar_grid, dyadic_grid, points, needles, diagonals, huge_over_tiny, edge_pairs;
Maker repeated_indices, repeated_positions;
// hard_cases_closed.cpp: watertight meshes, see HardCase::closed.
Maker sphere, far_sphere, cylinder, room;

// The number of triangles of a closed mesh where `asked` are asked for, see HardCase::triangle_count.
std::uint32_t closed_triangle_count(std::uint32_t asked);

// A pot of exactly `triangle_count` triangles, with no coordinate beyond 6 from `centre`; open where the
// count is odd or below LEAST_CLOSED_TRIANGLES.
Scene make_pot(std::uint32_t triangle_count, glm::vec3 centre);

// No triangles yet, and memory for so many with vertices of their own.
Scene reserved_scene(std::uint32_t triangle_count);

// Appends a triangle with its corners in a cube of half side `size` around `centre`.
void append_random_triangle(Scene& scene, glm::vec3 centre, float size, Random& random);

}  // namespace coppice::hard
