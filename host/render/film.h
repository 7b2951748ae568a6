#pragma once

#include <span>
#include <vector>

#include "interface/trace.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace coppice {

// The view that `camera` gives (see given_view), or where it is empty the scene's own or one that frames it.
View choose_view(const Scene& scene, std::span<const double> camera, std::uint32_t width,
                 std::uint32_t height);

// Of that view, and the lens of the scene.
Film make_film(const Scene& scene, std::span<const double> camera, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples);
Film make_film(const Camera& camera, const Lens& lens, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples);

// Radiance summed over so many samples a pixel (or its own count, where there are counts), in the order of
// FILM_STRIP, as means in rows from top to bottom. The quotients are those of `resolve`.
std::vector<vec3> mean_radiance(std::span<const vec3> sums, std::uint32_t width, std::uint32_t height,
                                std::uint32_t samples, std::span<const uint> sample_counts = {});

// A ray through the centre of each pixel, in the order of FILM_STRIP.
std::vector<Ray> rays_through(const Film& film);

}  // namespace coppice
