// Fog: its stage in lockstep with its twin, what comes through and what is scattered against closed forms and
// against integrals in double.
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "support/path_frame.h"
#include "support/path_scene.h"

namespace coppice {
namespace {

using DeviceFog = DeviceTest;

constexpr FogBox fog_of_test = {{-1, -1, -3}, {1, 1, 0}};

// Before a wall of black at z = -4, as the camera at z = 2 sees it.
Scene foggy_scene(float density, float albedo, float anisotropy = 0) {
  Scene scene = dark_scene();
  add_surface(scene, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, add_material(scene, vec3(0)));
  scene.camera = Camera{.position = {0.1f, 0.2f, 2}, .target = {0, 0, -4}, .vertical_fov_degrees = 20};
  scene.fog = Fog{.density = density,
                  .albedo = vec3(albedo),
                  .anisotropy = anisotropy,
                  .box = fog_of_test,
                  .origin = "/fog"};
  return scene;
}

// Where a line is in the box.
glm::dvec2 in_box(const glm::dvec3& origin, const glm::dvec3& direction, double end) {
  double first = 0, last = end;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (fog_of_test.min[axis] - origin[axis]) / direction[axis];
    const double b = (fog_of_test.max[axis] - origin[axis]) / direction[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return {first, std::max(first, last)};
}

double through_fog(double density, const glm::dvec3& from, const glm::dvec3& direction, double end) {
  const glm::dvec2 inside = in_box(from, direction, end);
  return std::exp(-density * (inside.y - inside.x));
}

double phase(double g, double cosine) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

// What arrives at a point of the fog: the irradiance across the way there, and whence it comes (unit length).
struct Arriving {
  double irradiance = 0;
  glm::dvec3 towards{0};
};

// Of light that is scattered once, the mean over the picture: an integral along the ray through the middle of
// each pixel.
double scattered_radiance(const Scene& scene, const PathView& view,
                          const std::function<Arriving(const glm::dvec3&)>& arriving) {
  const Film film = make_film(scene, {}, view.width, view.height, 1);
  const Fog& fog = *scene.fog;
  constexpr int steps = 400;
  double sum = 0;
  for (uint y = 0; y < view.height; ++y) {
    for (uint x = 0; x < view.width; ++x) {
      const glm::dvec3 origin(film.position);
      const glm::dvec3 direction = glm::normalize(
          glm::dvec3(film.corner) + glm::dvec3(film.right) * (x + 0.5) + glm::dvec3(film.down) * (y + 0.5));
      const glm::dvec2 inside = in_box(origin, direction, 1e9);
      const double step = (inside.y - inside.x) / steps;
      for (int k = 0; k < steps; ++k) {
        const double t = inside.x + (k + 0.5) * step;
        const Arriving light = arriving(origin + direction * t);
        sum += step * fog.density * fog.albedo.x * std::exp(-fog.density * (t - inside.x)) *
               light.irradiance * phase(fog.anisotropy, glm::dot(direction, light.towards));
      }
    }
  }
  return sum / (view.width * view.height);
}

double mean_red(const Scene& scene, const PathView& view) {
  return mean_radiance_of(path_picture(scene, view).radiance).x;
}

TEST_F(DeviceFog, EveryStageDoesWhatItsTwinDoes) {
  Scene scene = room_of_all_surfaces();
  scene.fog =
      Fog{.density = 0.4f, .albedo = {0.9f, 0.8f, 0.7f}, .anisotropy = 0.3f, .box = {}, .origin = "/fog"};
  for (const Walk walk : {Walk::binary, Walk::wide_single})
    EXPECT_EQ(difference_of(scene, PathView{.samples = 2, .walk = walk}), "");
  scene.global_illumination = false;
  scene.ambient_light = {0.1f, 0.2f, 0.3f};
  scene.environment = Environment{.image = {}, .folder = {}, .sky = Sky{}, .origin = "/environment"};
  scene.fog->box = FogBox{{-0.5f, 0.2f, -1}, {0.7f, 1.1f, 1.9f}};
  EXPECT_EQ(difference_of(scene, PathView{}), "");
  scene.environment.reset();
  EXPECT_EQ(difference_of(scene, PathView{.changes = "-emission,-lights"}), "") << "with ambient light alone";
}

// What absorbs and scatters nothing dims what is behind it, by Beer's law.
TEST_F(DeviceFog, DimsWhatIsBehindItByHowFarThatIs) {
  Scene scene = foggy_scene(0.7f, 0);
  scene.materials[0].emission = vec3(2);
  const PathView view{.width = 8, .height = 6};
  const Film film = make_film(scene, {}, view.width, view.height, 1);
  const std::vector<vec3> radiance = path_picture(scene, view).radiance;
  double expected = 0;
  for (uint y = 0; y < view.height; ++y) {
    for (uint x = 0; x < view.width; ++x) {
      const glm::dvec3 direction = glm::normalize(
          glm::dvec3(film.corner) + glm::dvec3(film.right) * (x + 0.5) + glm::dvec3(film.down) * (y + 0.5));
      expected += 2 * through_fog(0.7f, glm::dvec3(film.position), direction, 1e9);
    }
  }
  EXPECT_NEAR(mean_radiance_of(radiance).x / (expected / (view.width * view.height)), 1, 1e-5);
}

// The light that surfaces get, too.
TEST_F(DeviceFog, DimsLightOnItsWayToSurfaces) {
  Scene scene = foggy_scene(0.9f, 0);
  scene.materials[0].diffuse = vec3(0.8f);
  scene.light.radiance = vec3(1.5f);
  scene.light.direction = {0, 0, 1};
  scene.camera = Camera{.position = {0, 0, -3.5f}, .target = {0, 0, -4}, .vertical_fov_degrees = 60};
  EXPECT_NEAR(mean_red(scene, {.width = 4, .height = 4}), 0.8 * 1.5 * std::exp(-0.9 * 3), 1e-5);
  scene.light.radiance = vec3(0);
  scene.more_lights.push_back({.is_point = true, .place = {0, 0, -1}, .radiance = vec3(9), .origin = "lamp"});
  scene.camera->vertical_fov_degrees = 0.01f;
  EXPECT_NEAR(mean_red(scene, {.width = 4, .height = 4}), 0.8 * 9 / 9 * std::exp(-0.9 * 2), 1e-4);
}

TEST_F(DeviceFog, ScattersTheSunAsAnIntegralHasIt) {
  for (const float anisotropy : {0.0f, 0.6f, -0.4f}) {
    Scene scene = foggy_scene(0.8f, 0.9f, anisotropy);
    scene.light.radiance = vec3(2);
    scene.light.direction = {0.3f, 0.8f, -0.52f};
    const glm::dvec3 sun = glm::normalize(glm::dvec3(scene.light.direction));
    const PathView view{.width = 24, .height = 18, .samples = 64};
    const double expected = scattered_radiance(scene, view, [&](const glm::dvec3& place) {
      return Arriving{2 * std::numbers::pi * through_fog(0.8f, place, sun, 1e9), sun};
    });
    EXPECT_NEAR(mean_red(scene, view) / expected, 1, 0.01) << anisotropy;
  }
}

// A half of the sky is covered: there the fog is dark.
TEST_F(DeviceFog, IsDarkWhereTheSunDoesNotReach) {
  Scene scene = foggy_scene(0.5f, 0.8f);
  add_surface(scene, {0.05f, 3, -90}, {0, 0, 180}, {90, 0, 0}, 0);
  scene.light.radiance = vec3(2);
  scene.light.direction = {0, 1, 0};
  scene.light.shadows = true;
  const PathView view{.width = 24, .height = 18, .samples = 64};
  const auto arriving = [](bool shadows) {
    return [shadows](const glm::dvec3& place) {
      const glm::dvec3 up(1e-30, 1, 1e-30);
      const bool covered = shadows && place.x > 0.05;
      return Arriving{covered ? 0 : 2 * std::numbers::pi * through_fog(0.5f, place, up, 1e9), up};
    };
  };
  const double expected = scattered_radiance(scene, view, arriving(true));
  EXPECT_NEAR(mean_red(scene, view) / expected, 1, 0.01);
  EXPECT_NEAR(mean_red(scene, {.width = 24, .height = 18, .samples = 64, .changes = "-shadows"}) /
                  scattered_radiance(scene, view, arriving(false)),
              1, 0.01);
}

TEST_F(DeviceFog, ScattersLampsAsAnIntegralHasIt) {
  Scene scene = foggy_scene(0.4f, 0.7f, 0.2f);
  scene.more_lights.push_back(
      {.is_point = true, .place = {0.5f, 1.6f, -1}, .radiance = vec3(3), .origin = "lamp"});
  const PathView view{.width = 24, .height = 18, .samples = 64};
  const double expected = scattered_radiance(scene, view, [&](const glm::dvec3& place) {
    const glm::dvec3 way = glm::dvec3(0.5f, 1.6f, -1) - place;
    const double distance = glm::length(way);
    return Arriving{
        std::numbers::pi * 3 / (distance * distance) * through_fog(0.4f, place, way / distance, distance),
        way / distance};
  });
  EXPECT_NEAR(mean_red(scene, view) / expected, 1, 0.01);
}

// A small square that emits is a point of light, by the cosine at which it is seen.
TEST_F(DeviceFog, ScattersWhatSurfacesEmit) {
  Scene scene = foggy_scene(0.4f, 0.7f);
  add_surface(scene, {-0.05f, 1.6f, -1.05f}, {0.1f, 0, 0}, {0, 0, 0.1f},
              add_material(scene, vec3(0), vec3(300)));
  const PathView view{.width = 24, .height = 18, .samples = 64};
  const double expected = scattered_radiance(scene, view, [&](const glm::dvec3& place) {
    const glm::dvec3 way = glm::dvec3(0, 1.6, -1) - place;
    const double distance = glm::length(way);
    const double cosine = std::abs(way.y) / distance;
    return Arriving{
        300 * 0.01 * cosine / (distance * distance) * through_fog(0.4f, place, way / distance, distance),
        way / distance};
  });
  EXPECT_NEAR(mean_red(scene, view) / expected, 1, 0.02);
}

// Ambient light comes from everywhere, as much at every place.
TEST_F(DeviceFog, ScattersAmbientLightByItsAlbedo) {
  Scene scene = foggy_scene(40, 0.75f);
  scene.ambient_light = vec3(0.4f);
  scene.camera->vertical_fov_degrees = 1;
  EXPECT_NEAR(mean_red(scene, {.width = 4, .height = 4}), 0.75 * 0.4, 1e-6);
  scene.global_illumination = true;
  EXPECT_EQ(mean_red(scene, {.width = 4, .height = 4}), 0);
}

}  // namespace
}  // namespace coppice
