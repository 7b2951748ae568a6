// Triangles that let rays through: against closed forms, in shadows, through every tree, in lockstep.
#include <algorithm>
#include <cmath>

#include "measure/measure_frame.h"
#include "render/film.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/masked_scene.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class DeviceAlpha : public DeviceTest {};

constexpr std::uint32_t width = 60, height = 60;
constexpr Walk tree_walks[] = {Walk::binary, Walk::wide_packets, Walk::wide_single};

struct Picture {
  std::vector<uint> image;
  TraceCounters counters{}, shadow_counters{};
};

FrameOptions frame_options(Walk walk) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(width, height)};
  options.trace.walk = walk;
  return options;
}

Picture traced_picture(const Scene& scene, Walk walk = Walk::binary, const char* changes = "") {
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(changes)));
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, frame_options(walk));
  GpuExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, width, height, 1));
  Chain chain = executor.chain();
  append_frame(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(executor.read(plan.tree.state)[0].error_word, 0u);
  Picture picture{executor.read(plan.trace.image), executor.read(plan.trace.counters)[0], {}};
  if (plan.trace.lights.counters.count > 0)
    picture.shadow_counters = executor.read(plan.trace.lights.counters)[0];
  return picture;
}

std::vector<uint> picture_of(const Scene& scene, Walk walk = Walk::binary, const char* changes = "") {
  return traced_picture(scene, walk, changes).image;
}

// Where the ray of a pixel's centre meets the plane through `point` with this normal.
glm::dvec3 place_seen(const Film& film, uint x, uint y, glm::dvec3 point = {0, 0, 0},
                      glm::dvec3 normal = {0, 0, 1}) {
  const glm::dvec3 direction =
      glm::dvec3(film.corner) + glm::dvec3(film.right) * (x + 0.5) + glm::dvec3(film.down) * (y + 0.5);
  const glm::dvec3 origin(film.position);
  return origin + direction * (glm::dot(point - origin, normal) / glm::dot(direction, normal));
}

constexpr uint white = 0xffffffffu;

// Empty where there is none.
std::string difference_of(const Scene& scene, Walk walk) {
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene));
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, frame_options(walk));
  LockstepExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, make_film(scene, {}, width, height, 1));
  const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
  if (!difference) return "";
  return difference->stage + " " + difference->slot + " " + std::to_string(difference->index);
}

TEST_F(DeviceAlpha, AMaskIsThereFromItsCutoffOn) {
  // The middles of the texels are at -1/2 and 1/2, so 0.3 is at -1/5.
  const Scene scene = masked_square(opacity_of(2, 1, {0, 255}), 0.3f);
  const Film film = make_film(scene, {}, width, height, 1);
  for (const Walk walk : tree_walks) {
    const std::vector<uint> image = picture_of(scene, walk);
    int there = 0, holes = 0;
    for (uint y = 0; y < height; ++y) {
      for (uint x = 0; x < width; ++x) {
        const glm::dvec3 place = place_seen(film, x, y);
        if (std::max(std::abs(place.x), std::abs(place.y)) > 0.999 || std::abs(place.x + 0.2) < 1e-4)
          continue;
        const bool is_there = place.x > -0.2;
        ASSERT_EQ(image[y * width + x] == white, is_there) << name_of(walk) << " " << x << " " << y;
        (is_there ? there : holes) += 1;
      }
    }
    EXPECT_NEAR(double(there) / (there + holes), 0.6, 0.02);
  }
}

TEST_F(DeviceAlpha, CoverageIsTheShareOfRaysThatHit) {
  // From 0 at -1/2 to 1 at 1/2, of which 4 parts in 5.
  Scene scene = masked_square(opacity_of(2, 1, {0, 255}), {});
  scene.materials[0].opacity = 0.8f;
  const Film film = make_film(scene, {}, width, height, 1);
  const std::vector<uint> image = picture_of(scene);
  double covered = 0, expected = 0, variance = 0;
  for (uint y = 0; y < height; ++y) {
    for (uint x = 0; x < width; ++x) {
      const glm::dvec3 place = place_seen(film, x, y);
      if (std::max(std::abs(place.x), std::abs(place.y)) > 0.999) continue;
      const double share = 0.8 * std::clamp(place.x + 0.5, 0.0, 1.0);
      if (place.x < -0.501) {
        ASSERT_NE(image[y * width + x], white);
      }
      covered += image[y * width + x] == white;
      expected += share;
      variance += share * (1 - share);
    }
  }
  EXPECT_GT(expected, 500);
  EXPECT_NEAR(covered, expected, 3 * std::sqrt(variance));
  for (const Walk walk : tree_walks) EXPECT_EQ(picture_of(scene, walk), image) << name_of(walk);
}

TEST_F(DeviceAlpha, CoverageWithoutAnImageIsOneForTheWholeSurface) {
  Scene scene = masked_square({}, {});
  for (const float opacity : {0.25f, 0.5f, 0.9f}) {
    scene.materials[0].opacity = opacity;
    const Picture picture = traced_picture(scene), solid = traced_picture(scene, Walk::binary, "-alpha");
    const double all = solid.counters.hits.x, hit = picture.counters.hits.x;
    EXPECT_GT(all, 1500);
    EXPECT_NEAR(hit, opacity * all, 3 * std::sqrt(all * opacity * (1 - opacity)));
  }
}

TEST_F(DeviceAlpha, AnImageTexelIsWhereThatOfATextureIs) {
  Scene scene = masked_square(opacity_of(2, 2, {255, 0, 0, 0}), 0.9f);
  const std::vector<uint> image = picture_of(scene);
  EXPECT_EQ(image[16 * width + 16], white);
  EXPECT_NE(image[16 * width + 43], white);
  EXPECT_NE(image[43 * width + 16], white);
  EXPECT_NE(image[43 * width + 43], white);
}

// A floor of which the sun, right above, reaches what a masked square at height 1 lets through.
TEST_F(DeviceAlpha, ShadowsOfAMaskAreItsShape) {
  Scene scene;
  add_quad(scene, {-1, 1, -1}, {0, 0, 2}, {2, 0, 0});
  add_texcoords(scene);
  add_quad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  scene.texcoord_index.resize(scene.indices.size(), uvec3(~0u));
  scene.materials[0].opacity_map = opacity_of(2, 1, {0, 255});
  scene.materials[0].alpha_cutoff = 0.3f;
  scene.materials.push_back({});
  scene.materials[1].diffuse = vec3(1);
  scene.material_index[2] = scene.material_index[3] = 1;
  scene.light.direction = {0, 1, 0};
  scene.light.shadows = true;
  scene.ambient_light = vec3(0);
  scene.camera =
      Camera{.position = {0, 0.9f, 4}, .target = {0, 0, 0}};  // sees nothing of the square's upper side
  const Film film = make_film(scene, {}, width, height, 1);
  for (const Walk walk : tree_walks) {
    const Picture picture = traced_picture(scene, walk);
    int dark = 0, lit = 0;
    for (uint y = height / 3; y < height; ++y) {
      for (uint x = 0; x < width; ++x) {
        const glm::dvec3 place = place_seen(film, x, y, {0, 0, 0}, {0, 1, 0});
        if (std::max(std::abs(place.x), std::abs(place.z)) > 3.9 || place.z > 3) continue;
        const double edges[] = {place.x + 0.2, 1 - place.x, 1 + place.z, 1 - place.z};
        if (std::ranges::any_of(edges, [](double from) { return std::abs(from) < 1e-3; })) continue;
        const bool is_dark = std::ranges::all_of(edges, [](double from) { return from > 0; });
        const uint pixel = picture.image[y * width + x] & 0xffffffu;
        ASSERT_EQ(pixel == 0, is_dark) << name_of(walk) << " " << place.x << " " << place.z;
        (is_dark ? dark : lit) += 1;
      }
    }
    EXPECT_GT(dark, 100);
    EXPECT_GT(lit, 300);
    EXPECT_GT(picture.shadow_counters.rays.x, picture.shadow_counters.hits.x);
  }
}

TEST_F(DeviceAlpha, WhatIsNotThereIsAsIfItWereNotInTheScene) {
  Scene scene = triangles_over_plane(200);
  scene.light.shadows = true;
  Scene without = scene;
  scene.materials.push_back({});
  scene.materials[1].opacity = 0;
  for (const Triangle& t : random_triangles(100, 9, 0.5f)) {
    add_triangle(scene, t);
    scene.material_index.back() = 1;
  }
  for (const Walk walk : tree_walks) EXPECT_EQ(picture_of(scene, walk), picture_of(without)) << name_of(walk);
}

TEST_F(DeviceAlpha, SolidTrianglesAmongOthersAreHitAsEver) {
  Scene plain = triangles_over_plane(300);
  plain.light.shadows = true;
  Scene scene = plain;
  scene.materials.push_back({});
  scene.materials[1].opacity = 0.5f;
  add_triangle(scene, {{90, 90, 90}, {90, 91, 90}, {91, 90, 90}});  // behind the camera
  scene.material_index.back() = 1;
  ASSERT_TRUE(effects_of(scene).has(Effect::alpha));
  for (const Walk walk : tree_walks)
    EXPECT_EQ(picture_of(scene, walk), picture_of(scene, walk, "-alpha")) << name_of(walk);
}

TEST_F(DeviceAlpha, AllTreesShowTheSame) {
  Scene scene = masked_scene(300);
  scene.light.shadows = true;
  const std::vector<uint> binary = picture_of(scene);
  EXPECT_EQ(picture_of(scene, Walk::wide_packets), binary);
  EXPECT_EQ(picture_of(scene, Walk::wide_single), binary);
  EXPECT_NE(picture_of(scene, Walk::binary, "-alpha"), binary);
}

TEST_F(DeviceAlpha, StagesAreInLockstepWithTheirTwins) {
  Scene scene = masked_scene(300);
  scene.light.shadows = true;
  scene.more_lights.push_back({.is_point = true, .place = {1, 3, 2}, .shadows = true, .origin = ""});
  ASSERT_EQ(scene_arrays(scene, effects_of(scene)).alpha_counts().maps, 4u);
  for (const Walk walk : tree_walks) EXPECT_EQ(difference_of(scene, walk), "");
}

// Rays by which paths go on, and those to lights that are sampled there, go past holes, too.
TEST_F(DeviceAlpha, PathsAreInLockstepWithTheirTwins) {
  Scene scene = masked_scene(100);
  scene.global_illumination = true;
  scene.bounces = 2;
  scene.light.shadows = true;
  scene.materials[2].emission = {2, 1, 3};
  for (const Walk walk : {Walk::binary, Walk::wide_single}) EXPECT_EQ(difference_of(scene, walk), "");
}

// Coordinates that are no numbers, endless or huge, in every way of wrapping.
TEST_F(DeviceAlpha, AnyTextureCoordinatesAreInLockstep) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float places[] = {NAN,    infinity, -infinity,    1e30f, -8388607.5f,
                          1e-30f, -0.0f,    0.999999940f, 1,     3.25f};
  Scene scene;
  scene.materials.clear();
  for (uint i = 0; i < 27; ++i) {
    add_quad(scene, {float(i % 9) - 4.5f, float(i / 9) - 1.5f, 0}, {0, 1, 0}, {1, 0, 0});
    add_texcoords(scene);
    for (std::size_t k = scene.texcoords.size() - 4; k < scene.texcoords.size(); ++k)
      scene.texcoords[k] = {places[k % 10], places[k % 9]};
    scene.materials.emplace_back().opacity_map = opacity_of(3, 2, {0, 255, 128, 255, 64, 0});
    TextureMap& map = scene.materials.back().opacity_map;
    map.wrap_u = static_cast<TextureWrap>(i % 3);
    map.wrap_v = static_cast<TextureWrap>(i / 3 % 3);
    if (i % 2 == 0) scene.materials.back().alpha_cutoff = 0.4f;
    scene.material_index.back() = scene.material_index[scene.material_index.size() - 2] = i;
  }
  EXPECT_EQ(difference_of(scene, Walk::wide_single), "");
}

// In double, and so without the same bits of u and v.
TEST_F(DeviceAlpha, TheTracerOfTheHostSeesTheSameHoles) {
  Scene scene = masked_scene(200);
  scene.light.shadows = true;
  for (const char* const builder : {"sah", "none"}) {
    FrameRuns frame{.builder = {.name = builder}, .trace = test_trace_options(width, height)};
    const std::vector<uint> host = measure_host_frame(nullptr, scene, scene_arrays(scene, effects_of(scene)),
                                                      frame, [](const std::string&) {})
                                       .image;
    const std::vector<uint> device = picture_of(scene);
    std::size_t others = 0;
    for (std::size_t i = 0; i < host.size(); ++i) others += host[i] != device[i];
    EXPECT_LE(others, host.size() / 50) << builder;
  }
}

TEST_F(DeviceAlpha, WithoutATreeOrInTwoLevelsThereIsNone) {
  const SceneArrays arrays = scene_arrays(masked_scene(10), effects_of(masked_scene(10)));
  Layout layout(test_device().properties().max_block_bytes);
  EXPECT_THROW(plan_frame(layout, arrays, frame_options(Walk::brute_force)), std::invalid_argument);
  SceneArrays instanced = arrays;
  instanced.textures = {};
  instanced.mesh_index = {0};
  EXPECT_THROW(plan_frame(layout, instanced, frame_options(Walk::binary)), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
