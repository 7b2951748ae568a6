// Light of environments: every stage in lockstep with its twin, radiance against closed forms and against the
// image itself, by each strategy alone and by both.
#include <unistd.h>

#include <filesystem>
#include <glm/geometric.hpp>

#include "scene/write_exr.h"
#include "support/environment_images.h"
#include "support/path_frame.h"
#include "support/path_scene.h"
#include "support/textured_scene.h"

namespace coppice {
namespace {

constexpr double pi = std::numbers::pi;

class DeviceEnvironment : public DeviceTest {
 protected:
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    DeviceTest::TearDown();
  }

  void set_environment(Scene& scene, const RadianceImage& image) const {
    std::filesystem::create_directories(folder_);
    write_exr(folder_ / "image.exr", image.width, image.height, image.pixels);
    scene.environment =
        Environment{.image = "image.exr", .folder = folder_.string(), .sky = {}, .origin = "/environment"};
  }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("coppice_environment_" + std::to_string(getpid()));
};

struct LitView {
  std::uint32_t width = 4, height = 4, samples = 1;
  const char* changes = "";
  bool bounces_alone = false;  // no light is sampled, all is met
  Walk walk = Walk::binary;
  std::uint64_t work = 1u << 16;
};

SceneArrays arrays_of(const Scene& scene, const LitView& view) {
  SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(view.changes)));
  if (!view.bounces_alone) return arrays;
  PathArrays& paths = arrays.paths;
  paths.choices.clear();
  paths.counts.choices = 0;
  const std::size_t side = paths.surroundings[0].end;
  for (std::size_t y = 0; y < side; ++y) paths.surroundings[1 + side * side + y].radiance = vec3(0);
  return arrays;
}

PathView view_of(const LitView& view) {
  return {view.width, view.height, view.samples, view.walk, view.changes, view.work};
}

std::vector<vec3> picture_of(const Scene& scene, const LitView& view) {
  return path_picture(scene, arrays_of(scene, view), view_of(view)).radiance;
}

std::string lockstep_difference(const Scene& scene, const LitView& view) {
  return difference_of(scene, arrays_of(scene, view), view_of(view));
}

// A plane that fills the picture.
Scene plane_from_above(vec3 albedo) {
  Scene scene = dark_scene();
  add_surface(scene, {-90, 0, -90}, {0, 0, 180}, {180, 0, 0}, add_material(scene, albedo));
  scene.camera = Camera{.position = {0, 4, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 10};
  scene.bounces = 1;
  return scene;
}

RadianceImage spotted_sky() {
  RadianceImage image = even_image({0.2f, 0.3f, 0.4f});
  add_spot(image, glm::normalize(glm::dvec3(0.6, 1, -0.5)), {60, 50, 40});
  return image;
}

// The room is open to all sides where a wall is missing.
Scene open_room() {
  Scene scene = room_of_all_surfaces();
  for (int side = 0; side < 2; ++side) {
    scene.indices.erase(scene.indices.begin() + 6, scene.indices.begin() + 8);
    scene.material_index.erase(scene.material_index.begin() + 6, scene.material_index.begin() + 8);
  }
  return scene;
}

TEST_F(DeviceEnvironment, EveryStageDoesWhatItsTwinDoes) {
  Scene scene = open_room();
  set_environment(scene, spotted_sky());
  for (const Walk walk : {Walk::binary, Walk::wide_single, Walk::wide_packets}) {
    EXPECT_EQ(lockstep_difference(scene, {.width = 24, .height = 18, .samples = 2, .walk = walk}), "");
  }
  EXPECT_EQ(lockstep_difference(scene, {.width = 24, .height = 18, .changes = "-shadows,-emission"}), "");
  EXPECT_EQ(lockstep_difference(scene, {.width = 24, .height = 18, .bounces_alone = true}), "");
}

TEST_F(DeviceEnvironment, EveryStageDoesWhatItsTwinDoesUnderASkyWithTextures) {
  Scene scene = textured_scene(100);
  scene.environment = Environment{.image = "", .folder = "", .sky = Sky{}, .origin = "/environment"};
  EXPECT_EQ(lockstep_difference(scene, {.width = 24, .height = 18}), "");
}

TEST_F(DeviceEnvironment, TheSameBitsHoweverATraceIsCut) {
  Scene scene = open_room();
  set_environment(scene, spotted_sky());
  const LitView view{.width = 48, .height = 36, .samples = 2};
  const std::vector<vec3> whole = picture_of(scene, view);
  for (const Walk walk : {Walk::wide_single, Walk::wide_packets}) {
    LitView other = view;
    other.walk = walk;
    other.work = 1;
    EXPECT_EQ(picture_of(scene, other), whole);
  }
}

// White furnace: what is convex and of one albedo shows exactly albedo times radiance under an even sky.
TEST_F(DeviceEnvironment, UnderAnEvenSkyASurfaceIsAsBrightAsItsAlbedo) {
  Scene scene = plane_from_above({0.25f, 0.5f, 1});
  set_environment(scene, even_image(vec3(2)));
  for (const bool bounces : {false, true}) {
    scene.global_illumination = bounces;
    for (const bool alone : {false, true}) {
      if (alone && !bounces) continue;
      const glm::dvec3 seen = mean_radiance_of(
          picture_of(scene, {.width = 8, .height = 8, .samples = 256, .bounces_alone = alone}));
      EXPECT_NEAR(seen.x, 0.5, 0.0025) << bounces << alone;
      EXPECT_NEAR(seen.y, 1, 0.005) << bounces << alone;
      EXPECT_NEAR(seen.z, 2, 0.01) << bounces << alone;
    }
  }
}

TEST_F(DeviceEnvironment, ALightSpotLightsAsMuchByEachStrategyAsByBothAndAsTheImageSays) {
  Scene scene = plane_from_above({0.8f, 0.8f, 0.8f});
  const RadianceImage sky = spotted_sky();
  set_environment(scene, sky);
  const glm::dvec3 wanted = 0.8 / pi * irradiance_from_above(sky);
  const glm::dvec3 lights = mean_radiance_of(picture_of(scene, {.samples = 1024}));
  scene.global_illumination = true;
  const glm::dvec3 both = mean_radiance_of(picture_of(scene, {.samples = 1024}));
  const glm::dvec3 bounces =
      mean_radiance_of(picture_of(scene, {.width = 8, .height = 8, .samples = 4096, .bounces_alone = true}));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(lights[channel], wanted[channel], 0.01 * wanted[channel]);
    EXPECT_NEAR(both[channel], wanted[channel], 0.01 * wanted[channel]);
    EXPECT_NEAR(bounces[channel], wanted[channel], 0.02 * wanted[channel]);
  }
}

TEST_F(DeviceEnvironment, AGlossyMetalIsAsBrightWithLightSamplesAsWithout) {
  Scene scene = plane_from_above(vec3(0.9f));
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.5f;
  RadianceImage sky = even_image(vec3(0.2f));
  add_spot(sky, glm::normalize(glm::dvec3(0.2, 4, -3)), vec3(60));
  set_environment(scene, sky);
  const double both = mean_radiance_of(picture_of(scene, {.samples = 1024})).x;
  const double alone =
      mean_radiance_of(picture_of(scene, {.width = 8, .height = 8, .samples = 4096, .bounces_alone = true}))
          .x;
  EXPECT_GT(alone, 0.5);
  EXPECT_NEAR(both, alone, 0.02 * alone);
}

TEST_F(DeviceEnvironment, IsTheBackgroundAndIsSeenWhereTheImageHasIt) {
  Scene scene = dark_scene();
  add_surface(scene, {90, 90, 90}, {1, 0, 0}, {0, 1, 0}, add_material(scene, vec3(0.5f)));
  RadianceImage image = even_image(vec3(0), 256, 128);
  add_spot(image, {1, 0, 0}, {3, 0, 0}, 8);
  add_spot(image, {0, 0, -1}, {0, 2, 0}, 8);
  set_environment(scene, image);
  const auto ahead = [&](vec3 direction) {
    scene.camera =
        Camera{.position = {0, 0, 0}, .target = direction, .up = {0, 1, 0}, .vertical_fov_degrees = 2};
    return mean_radiance_of(picture_of(scene, {}));
  };
  EXPECT_NEAR(glm::distance(ahead({1, 0, 0}), glm::dvec3(3, 0, 0)), 0, 0.05);
  EXPECT_NEAR(glm::distance(ahead({0, 0, -1}), glm::dvec3(0, 2, 0)), 0, 0.05);
  EXPECT_EQ(ahead({-1, 0, 0}), glm::dvec3(0));
  scene.environment->rotation_degrees = 90;
  EXPECT_NEAR(glm::distance(ahead({0, 0, -1}), glm::dvec3(3, 0, 0)), 0, 0.05);
  EXPECT_NEAR(glm::distance(ahead({-1, 0, 0}), glm::dvec3(0, 2, 0)), 0, 0.05);
  scene.environment->intensity = 2;
  EXPECT_NEAR(glm::distance(ahead({0, 0, -1}), glm::dvec3(6, 0, 0)), 0, 0.1);
}

// Mirrors and glass show it as it is: nothing is shared with light samples there.
TEST_F(DeviceEnvironment, AMirrorShowsIt) {
  Scene scene = plane_from_above(vec3(1));
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.0f;
  set_environment(scene, even_image({0.5f, 1, 2}));
  const glm::dvec3 seen = mean_radiance_of(picture_of(scene, {.samples = 4}));
  EXPECT_NEAR(glm::distance(seen, glm::dvec3(0.5, 1, 2)), 0, 1e-4);
}

// A spot at the zenith, the same all around: what covers half of it takes half of its light.
TEST_F(DeviceEnvironment, AHalfCoveredSpotIsHalfAsBrightAndACoveredOneDark) {
  RadianceImage sky = even_image(vec3(0));
  std::fill_n(sky.pixels.begin(), 64, vec3(30));
  const double open = 0.8 / pi * irradiance_from_above(sky).x;
  for (const auto& [from, covered] : {std::pair{20.0f, 0.0}, std::pair{0.0f, 0.5}, std::pair{-5.0f, 1.0}}) {
    Scene scene = dark_scene();
    add_surface(scene, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, add_material(scene, vec3(0.8f)));
    add_surface(scene, {from, 1, -5}, {10, 0, 0}, {0, 0, 10}, add_material(scene, vec3(0)));
    scene.camera = Camera{.position = {-0.5f, 0.2f, 0}, .target = {0, 0, 0}, .vertical_fov_degrees = 0.25f};
    set_environment(scene, sky);
    const double seen = mean_radiance_of(picture_of(scene, {.samples = 1024})).x;
    EXPECT_NEAR(seen, (1 - covered) * open, 0.01 * open) << covered;
    EXPECT_NEAR(mean_radiance_of(picture_of(scene, {.samples = 256, .changes = "-shadows"})).x, open,
                0.02 * open);
  }
}

TEST_F(DeviceEnvironment, WhereItIsOffAllIsAsWithout) {
  Scene scene = open_room();
  const std::vector<vec3> without = picture_of(scene, {.width = 24, .height = 18});
  set_environment(scene, spotted_sky());
  EXPECT_EQ(picture_of(scene, {.width = 24, .height = 18, .changes = "-environment"}), without);
  const std::vector<vec3> lit = picture_of(scene, {.width = 24, .height = 18});
  EXPECT_NE(lit, without);
  scene.ambient_light = vec3(1);
  EXPECT_EQ(picture_of(scene, {.width = 24, .height = 18}), lit) << "ambient light has no place beside it";
}

TEST_F(DeviceEnvironment, ABlackOneIsNight) {
  Scene scene = plane_from_above(vec3(0.5f));
  set_environment(scene, even_image(vec3(0)));
  EXPECT_EQ(mean_radiance_of(picture_of(scene, {})), glm::dvec3(0));
}

}  // namespace
}  // namespace coppice
