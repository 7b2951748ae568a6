#include "render/film.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace coppice {

View choose_view(const Scene& scene, std::span<const double> given, std::uint32_t width,
                 std::uint32_t height) {
  if (!given.empty()) return given_view(scene, given);
  return view_of(frame_scene(scene, static_cast<float>(width) / static_cast<float>(height)));
}

namespace {

// Focus at the target, if at nothing else.
void add_lens(Film& film, const View& view, const Lens& lens) {
  const double radius = double{lens.aperture} / 2;
  const double focus = lens.focus > 0 ? double{lens.focus} : glm::length(view.target - view.eye);
  film.lens_right = view.right * radius;
  film.lens_down = view.down * radius;
  film.per_focus = static_cast<float>(std::min(1 / focus, double{FLT_MAX}));
}

Film film_of(const View& view, const Lens& lens, std::uint32_t width, std::uint32_t height,
             std::uint32_t samples) {
  const double half_height = std::tan(glm::radians(view.vertical_fov_degrees) / 2);
  const double half_width = half_height * width / height;
  Film film{};
  film.position = glm::clamp(view.eye, -double{FLT_MAX}, double{FLT_MAX});
  film.width = width;
  film.height = height;
  film.samples = samples;
  film.corner = view.forward - view.right * half_width - view.down * half_height;
  film.right = view.right * (2 * half_width / width);
  film.down = view.down * (2 * half_height / height);
  add_lens(film, view, lens);
  return film;
}

}  // namespace

Film make_film(const Scene& scene, std::span<const double> given, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples) {
  return film_of(choose_view(scene, given, width, height), scene.lens, width, height, samples);
}

Film make_film(const Camera& camera, const Lens& lens, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples) {
  return film_of(view_of(camera), lens, width, height, samples);
}

std::vector<vec3> mean_radiance(std::span<const vec3> sums, std::uint32_t width, std::uint32_t height,
                                std::uint32_t samples, std::span<const uint> sample_counts) {
  std::vector<vec3> means(sums.size());
  std::size_t ray = 0;
  for (std::uint32_t top = 0; top < height; top += FILM_STRIP) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (std::uint32_t y = top; y < std::min(top + FILM_STRIP, height); ++y) {
        const uint count = sample_counts.empty() ? samples : sample_counts[ray];
        means[std::size_t{y} * width + x] = sums[ray++] / static_cast<float>(count);
      }
    }
  }
  return means;
}

std::vector<Ray> rays_through(const Film& film) {
  std::vector<Ray> rays;
  for (std::uint32_t top = 0; top < film.height; top += FILM_STRIP) {
    for (std::uint32_t x = 0; x < film.width; ++x) {
      for (std::uint32_t y = top; y < std::min(top + FILM_STRIP, film.height); ++y) {
        const vec3 direction = film.corner + film.right * (static_cast<float>(x) + 0.5f) +
                               film.down * (static_cast<float>(y) + 0.5f);
        rays.push_back({film.position, 0, direction, std::numeric_limits<float>::infinity()});
      }
    }
  }
  return rays;
}

}  // namespace coppice
