#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "scene/scene.h"

namespace coppice {

// Where one looks from, and whither. In double: no two points of a file coincide in it that are apart.
struct View {
  glm::dvec3 eye, target;           // in the scene's coordinates
  glm::dvec3 forward, right, down;  // of unit length and at right angles
  double vertical_fov_degrees;
};

// Where a camera looks straight along its `up`, the picture's upper edge is where it would be had the camera
// come there by nodding from a view along -z: -z seen from above, +z from below.
View view_of(const Camera& camera);

// The numbers of --camera, in the coordinates of the file: eye and target, then, where there are 7 or 10, the
// vertical field of view in degrees, and, where there are 9 or 10, the direction that is up in the picture;
// 40 degrees and the scene's +y if not given. `numbers` is one that complaint_about_view has none about.
View given_view(const Scene& scene, std::span<const double> numbers);

// What is wrong with such numbers, empty if nothing: their count, not finite, eye and target not apart, up of
// no length or along the line of sight, a field of view not between 0 and 180 degrees.
std::string complaint_about_view(std::span<const double> numbers);

}  // namespace coppice
