// A detail in a scene whose box is far larger: what follows from the size of the whole must not be felt in
// the part.
#include <algorithm>

#include "scene/hard_case_makers.h"
#include "scene/shapes.h"

namespace coppice::hard {
namespace {

constexpr float FAR_SIDE = 6e6f;  // the pots are within 6 of their centre

std::uint32_t all_but(std::uint32_t triangle_count, std::uint32_t others) {
  return triangle_count < others ? 0 : triangle_count - others;
}

// A pot around a centre that fills the picture: the whole scene would show none.
Camera looking_at_pot(glm::vec3 centre) {
  Camera camera;
  camera.position = centre + glm::vec3{1, 6, 25};
  camera.target = centre;
  return camera;
}

}  // namespace

Scene detail_on_ground(std::uint32_t triangle_count, std::uint64_t) {
  constexpr glm::vec3 centre{0, 6, 0};
  Scene scene = make_pot(all_but(triangle_count, 2), centre);
  scene.camera = looking_at_pot(centre);
  const glm::vec3 a{-FAR_SIDE, 0, -FAR_SIDE}, c{FAR_SIDE, 0, FAR_SIDE};
  if (triangle_count > 0) append_triangle(scene, a, {-FAR_SIDE, 0, FAR_SIDE}, c, 0);
  if (triangle_count > 1) append_triangle(scene, a, c, {FAR_SIDE, 0, -FAR_SIDE}, 0);
  return scene;
}

// The dome is an octahedron.
Scene detail_in_dome(std::uint32_t triangle_count, std::uint64_t) {
  const std::uint32_t sides = std::min(triangle_count, 8u);
  Scene scene = make_pot(triangle_count - sides, glm::vec3{0});
  scene.camera = looking_at_pot(glm::vec3{0});
  for (std::uint32_t side = 0; side < sides; ++side) {
    const auto corner = [&](std::uint32_t axis) {
      glm::vec3 position{0};
      position[static_cast<int>(axis)] = side >> axis & 1 ? -FAR_SIDE : FAR_SIDE;
      return position;
    };
    append_triangle(scene, corner(0), corner(1), corner(2), 0);
  }
  return scene;
}

Scene stray_corner(std::uint32_t triangle_count, std::uint64_t) {
  Scene scene = make_pot(all_but(triangle_count, 1), glm::vec3{0});
  scene.camera = looking_at_pot(glm::vec3{0});
  if (triangle_count > 0)
    append_triangle(scene, {0, 6, 0}, {1, 6, 0}, {FAR_SIDE, FAR_SIDE / 2, FAR_SIDE / 4}, 0);
  return scene;
}

// Each pot is a hundred times as large as the one before, and stands beside it.
Scene detail_in_detail(std::uint32_t triangle_count, std::uint64_t) {
  constexpr std::uint32_t pots = 4;
  constexpr glm::vec3 centre{8, 0, 0};
  Scene scene = reserved_scene(triangle_count);
  scene.camera = looking_at_pot(centre);
  float scale = 1;
  for (std::uint32_t pot = 0; pot < pots; ++pot, scale *= 100) {
    const Scene part = make_pot((triangle_count + pot) / pots, centre);
    const glm::uvec3 first{static_cast<std::uint32_t>(scene.positions.size())};
    for (const glm::vec3& position : part.positions) scene.positions.push_back(position * scale);
    for (const glm::uvec3& indices : part.indices) scene.indices.push_back(indices + first);
  }
  scene.material_index.assign(scene.indices.size(), 0);
  return scene;
}

}  // namespace coppice::hard
