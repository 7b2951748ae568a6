#pragma once

#include <span>
#include <vector>

#include "pipeline/trace.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace coppice {

// A scene as the stages take it.
struct SceneArrays {
  std::vector<Triangle> triangles;  // denormal coordinates and -0 as +0: what every device computes alike
  std::vector<uint> material_index;
  std::vector<SurfaceMaterial> materials;
  Lighting lighting = {};
};

SceneArrays scene_arrays(const Scene& scene);

// The scene's warnings, a line each, to stderr.
void print_warnings(const Scene& scene);

// The view that `camera` gives (see given_view), or where it is empty the scene's own or one that frames it.
View choose_view(const Scene& scene, std::span<const double> camera, std::uint32_t width,
                 std::uint32_t height);

// Of that view.
Film make_film(const Scene& scene, std::span<const double> camera, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples);

// A ray through the centre of each pixel, in the order of FILM_STRIP.
std::vector<Ray> rays_through(const Film& film);

// Uploads all that a build and a trace read, through any executor.
template <class Executor>
void upload_frame(Executor& executor, const TreeSlots& tree, const TracePlan& trace, const SceneArrays& scene,
                  const Film& film) {
  const auto thresholds = srgb_thresholds();
  executor.upload(tree.triangles, std::span<const Triangle>(scene.triangles));
  executor.upload(trace.material_index, std::span<const uint>(scene.material_index));
  executor.upload(trace.materials, std::span<const SurfaceMaterial>(scene.materials));
  executor.upload(trace.lighting, std::span<const Lighting>(&scene.lighting, 1));
  executor.upload(trace.film, std::span<const Film>(&film, 1));
  executor.upload(trace.srgb_thresholds, std::span<const uint>(thresholds));
}

}  // namespace coppice
