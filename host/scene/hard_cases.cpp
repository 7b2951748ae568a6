#include "scene/hard_cases.h"

#include <array>

#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice {
namespace {

constexpr std::array HARD_CASES = std::to_array<HardCase>({
    {"coincident", "copies of one triangle", 100'000, hard::coincident},
    {"coincident-and-random", "by turns copies of one triangle and random ones", 10'000,
     hard::coincident_and_random},
    {"nested", "growing boxes around one centre", 10'000, hard::nested},
    {"nested-shells", "growing triangles in four planes, all with one centroid", 10'000, hard::nested_shells},
    {"shrinking-gaps", "a row in which each one's nearest neighbour is the next one", 1'000'000,
     hard::shrinking_gaps},
    {"shrinking-gaps-plane", "a grid in a plane whose gaps shrink slowly in every row", 10'000,
     hard::shrinking_gaps_plane},
    {"shrinking-gaps-spiral", "a spiral of even arms along which the gaps shrink slowly", 10'000,
     hard::shrinking_gaps_spiral},
    {"geometric-gaps", "a row whose gaps and triangles shrink by a constant factor", 10'000,
     hard::geometric_gaps},
    {"geometric-gaps-plane", "a grid in a plane whose rows and columns shrink by a constant factor", 10'000,
     hard::geometric_gaps_plane},
    {"geometric-gaps-spiral", "a logarithmic spiral, gaps and triangles shrink by a constant factor", 10'000,
     hard::geometric_gaps_spiral},
    {"one-cell", "a tiny cluster and one far outlier", 10'000, hard::one_cell},
    {"stadium", "a finely tessellated pot in a stadium: one cell of 30-bit codes holds it", 10'000,
     hard::stadium},
    {"planar-grid", "a grid in an axis-aligned plane, of no extent across it", 10'000, hard::planar_grid},
    {"dyadic-grid", "a height field whose coordinates are multiples of 1/256", 10'000, hard::dyadic_grid},
    {"points", "triangles that are points and segments", 1'000, hard::points},
    {"needles", "long triangles with an area near zero", 10'000, hard::needles},
    {"diagonals", "long thin triangles along the diagonals of a cube", 2'000, hard::diagonals},
    {"huge-over-tiny", "one huge triangle over a field of tiny ones", 10'001, hard::huge_over_tiny},
    {"edge-pairs", "pairs of triangles with a common edge, flat or folded, to be seen edge-on", 2,
     hard::edge_pairs},
    {"repeated-indices", "index buffer with the same vertex twice or three times in a triangle", 5'000,
     hard::repeated_indices},
    {"repeated-positions", "a connected surface without shared vertices: positions under several indices",
     10'000, hard::repeated_positions},
    {"non-finite", "every third triangle has a NaN or an infinite vertex", 1'000, hard::non_finite},
    {"all-non-finite", "every triangle has a NaN or an infinite vertex", 100, hard::all_non_finite},
    {"huge", "coordinates up to 3e38", 1'000, hard::huge},
    {"large", "coordinates near 1e18", 1'000, hard::large},
    {"tiny", "coordinates near 1e-38, denormals among them", 1'000, hard::tiny},
    {"mixed-scales", "triangles of size 1e-20 and 1e20 around one centre", 1'000, hard::mixed_scales},
    {"detail-on-ground", "a pot on a square ground a million times as wide", 10'000, hard::detail_on_ground},
    {"detail-in-dome", "a pot in a dome a million times as wide", 10'000, hard::detail_in_dome},
    {"stray-corner", "a pot, and a triangle with one corner a million times as far away", 10'000,
     hard::stray_corner},
    {"detail-in-detail", "four pots, each a hundred times as large as the one before", 10'000,
     hard::detail_in_detail},
    {"far", "a terrain moved to (148376, 1234, -223423)", 10'000, hard::far},
    {"farther", "a terrain moved to (1e7, 1e7, -1e7)", 10'000, hard::farther},
    {"negative-zero", "coordinates -1, -0, 0 and 1", 1'000, hard::negative_zero},
    {"sphere", "a closed sphere, to be seen from inside", 10'000, hard::sphere, true},
    {"far-sphere", "a closed sphere around (148376, 1234, -223423), to be seen from inside", 10'000,
     hard::far_sphere, true},
    {"cylinder", "a closed cylinder, its caps are fans, to be seen from inside", 10'000, hard::cylinder,
     true},
    {"room", "a terrain closed by walls and a ceiling, to be seen from inside", 10'000, hard::room, true},
});

}  // namespace

std::uint32_t HardCase::triangle_count(std::uint32_t asked) const {
  return closed ? hard::closed_triangle_count(asked) : asked;
}

std::span<const HardCase> hard_cases() { return HARD_CASES; }

const HardCase* find_hard_case(std::string_view name) {
  for (const HardCase& hard_case : HARD_CASES) {
    if (hard_case.name == name) return &hard_case;
  }
  return nullptr;
}

namespace hard {

Scene reserved_scene(std::uint32_t triangle_count) {
  Scene scene;
  scene.positions.reserve(std::size_t{triangle_count} * 3);
  scene.indices.reserve(triangle_count);
  scene.material_index.reserve(triangle_count);
  return scene;
}

void append_random_triangle(Scene& scene, glm::vec3 centre, float size, Random& random) {
  const glm::vec3 a = centre + size * random.in_cube();
  const glm::vec3 b = centre + size * random.in_cube();
  append_triangle(scene, a, b, centre + size * random.in_cube(), 0);
}

}  // namespace hard
}  // namespace coppice
