// Textures in pictures: against closed forms, with lights and shadows, through every tree, in lockstep.
#include <cmath>

#include "render/film.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"
#include "support/textured_scene.h"

namespace coppice {
namespace {

class DeviceTextureHits : public DeviceTest {};

constexpr std::uint32_t width = 60, height = 60;

FrameOptions textured_options(Walk walk) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(width, height)};
  options.trace.walk = walk;
  return options;
}

std::vector<uint> textured_picture(const Scene& scene, Walk walk = Walk::binary, const char* changes = "") {
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(changes)));
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, textured_options(walk));
  GpuExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, width, height, 1));
  Chain chain = executor.chain();
  append_frame(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(executor.read(plan.tree.state)[0].error_word, 0u);
  return executor.read(plan.trace.image);
}

// Where the ray of a pixel's centre meets the plane z = 0, from -1 to 1 on the square.
glm::dvec2 place_seen(const Film& film, uint x, uint y) {
  const glm::dvec3 direction =
      glm::dvec3(film.corner) + glm::dvec3(film.right) * (x + 0.5) + glm::dvec3(film.down) * (y + 0.5);
  const glm::dvec3 point = glm::dvec3(film.position) - direction * (film.position.z / direction.z);
  return {point.x, point.y};
}

double srgb_code(double linear) {
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

TEST_F(DeviceTextureHits, ColoursBetweenTexelsAreOnALine) {
  const Scene scene = textured_square(map_of(2, 1, {0xff0000, 0x00ff00}), 4);
  const Film film = make_film(scene, {}, width, height, 1);
  const std::vector<uint> image = textured_picture(scene);
  int seen = 0;
  for (uint y = 0; y < height; ++y) {
    for (uint x = 0; x < width; ++x) {
      const glm::dvec2 place = place_seen(film, x, y);
      if (std::max(std::abs(place.x), std::abs(place.y)) > 0.99) continue;
      ++seen;
      // The middles of the texels are at -1/2 and 1/2.
      const double green = std::clamp(place.x + 0.5, 0.0, 1.0);
      const uint pixel = image[y * width + x];
      ASSERT_NEAR(pixel & 255, srgb_code(1 - green), 1) << x << " " << y;
      ASSERT_NEAR(pixel >> 8 & 255, srgb_code(green), 1) << x << " " << y;
      ASSERT_EQ(pixel >> 16 & 255, 0u);
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST_F(DeviceTextureHits, TheUpperLeftTexelIsWhereThatOfTheImageIs) {
  const Scene scene = textured_square(map_of(2, 2, {0xff0000, 0x00ff00, 0x0000ff, 0xffffff}), 4);
  const std::vector<uint> image = textured_picture(scene);
  const auto at = [&](uint x, uint y) { return image[y * width + x] & 0xffffffu; };
  EXPECT_EQ(at(14, 14), 0x0000ffu);  // red, in the lowest byte
  EXPECT_EQ(at(45, 14), 0x00ff00u);
  EXPECT_EQ(at(14, 45), 0xff0000u);
  EXPECT_EQ(at(45, 45), 0xffffffu);
}

TEST_F(DeviceTextureHits, FromAfarTexelsAreTheirMean) {
  std::vector<std::uint32_t> pixels;
  for (uint i = 0; i < 256 * 256; ++i) pixels.push_back((i % 256 + i / 256) % 2 == 0 ? 0xffffffu : 0u);
  const Scene scene = textured_square(map_of(256, 256, pixels), 5);
  const Film film = make_film(scene, {}, width, height, 1);
  const std::vector<uint> image = textured_picture(scene);
  for (uint y = 0; y < height; ++y) {
    for (uint x = 0; x < width; ++x) {
      const glm::dvec2 place = place_seen(film, x, y);
      if (std::max(std::abs(place.x), std::abs(place.y)) > 0.99) continue;
      // About 8 texels a pixel. The mean is that of the light, not of the codes.
      ASSERT_NEAR(image[y * width + x] & 255, srgb_code(0.5), 1) << x << " " << y;
    }
  }
}

TEST_F(DeviceTextureHits, WithoutTheEffectThePictureIsThatOfTheMaterialAlone) {
  const Scene scene = textured_scene(200);
  Scene plain = scene;
  for (Material& material : plain.materials) {
    material.diffuse_map = material.emission_map = {};
    material.is_unlit = true;  // without a map it would be a light
  }
  EXPECT_EQ(textured_picture(scene, Walk::binary, "-textures"), textured_picture(plain));
  EXPECT_NE(textured_picture(scene), textured_picture(plain));
}

TEST_F(DeviceTextureHits, AllTreesShowTheSame) {
  Scene scene = textured_scene(300);
  scene.light.shadows = true;
  const std::vector<uint> binary = textured_picture(scene);
  EXPECT_EQ(textured_picture(scene, Walk::wide_packets), binary);
  EXPECT_EQ(textured_picture(scene, Walk::wide_single), binary);
}

TEST_F(DeviceTextureHits, StagesAreInLockstepWithTheirTwins) {
  Scene scene = textured_scene(300);
  scene.light.shadows = true;
  scene.more_lights.push_back({.is_point = true, .place = {1, 3, 2}, .origin = ""});
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene));
  ASSERT_EQ(arrays.texture_counts().textures, 2u);
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, textured_options(Walk::binary));
  LockstepExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, width, height, 1));
  const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
  EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << " " << difference->index;
}

}  // namespace
}  // namespace coppice
