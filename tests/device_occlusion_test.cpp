// Ambient occlusion: what walls of known height and distance keep off against closed forms, every stage in
// lockstep with its twin, the same bits however a trace is cut.
#include <cmath>
#include <functional>
#include <numbers>

#include "render/film.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/lit_scene.h"
#include "support/moving_frames.h"
#include "support/moving_scenes.h"
#include "support/test_device.h"
#include "support/traced_frame.h"

namespace coppice {
namespace {

using DeviceOcclusion = DeviceTest;

constexpr std::uint32_t occluded_side = 32;  // of a picture, in pixels

struct Occluded {
  std::vector<vec3> radiance;
  std::vector<uint> image;
  TraceCounts camera, rays;
};

FrameOptions occluded_options(std::uint32_t samples, Walk walk = Walk::binary) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(occluded_side, occluded_side)};
  options.trace.samples = samples;
  options.trace.walk = walk;
  options.trace.keep_radiance = true;
  return options;
}

Occluded occluded(const Scene& scene, const FrameOptions& options, const char* changes = "",
                  std::uint64_t work = ~std::uint64_t{0}) {
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(changes)));
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  GpuExecutor executor(test_device(), layout);
  const std::uint32_t samples = options.trace.samples;
  upload_frame(executor, plan, arrays, make_film(scene, {}, occluded_side, occluded_side, samples));
  trace_frame_in_pieces(executor, plan, work);
  Occluded result{mean_radiance(executor.read(plan.trace.radiance), occluded_side, occluded_side, samples),
                  executor.read(plan.trace.image),
                  counts_of(executor.read(plan.trace.counters)[0]),
                  {}};
  if (plan.trace.lights.occlusion_counters.count > 0)
    result.rays = counts_of(executor.read(plan.trace.lights.occlusion_counters)[0]);
  return result;
}

// White ground, of which rays leave by a millionth of its size, and a wall in the plane x = 0 of this height
// and a length that nobody sees end; from above. Ambient light alone.
Scene wall_on_ground(float height) {
  constexpr float far = 1e5f;
  Scene scene;
  add_quad(scene, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0});
  if (height > 0) add_quad(scene, {0, 0, -far}, {0, 0, 2 * far}, {0, height, 0});
  scene.materials[0].diffuse = vec3(1);
  scene.light.radiance = vec3(0);
  scene.ambient_light = vec3(0.5f, 1, 0.25f);
  scene.camera =
      Camera{.position = {2, 4, 0}, .target = {2, 0, 0}, .up = {0, 0, -1}, .vertical_fov_degrees = 50};
  return scene;
}

// Columns of the picture against the part of the light that reaches the ground at a distance from the wall.
void check_columns(const Scene& scene, const std::function<double(double)>& reached) {
  const Occluded seen = occluded(scene, occluded_options(64));
  const double half = 4 * std::tan(25 * std::numbers::pi / 180);
  for (std::uint32_t x = 0; x < occluded_side; ++x) {
    double mean = 0;
    for (std::uint32_t y = 0; y < occluded_side; ++y)
      mean += seen.radiance[y * occluded_side + x].x / occluded_side;
    const double distance = 2 + half * ((x + 0.5) / occluded_side * 2 - 1);
    EXPECT_NEAR(mean / 0.5, reached(distance), 0.02) << distance;
  }
  EXPECT_EQ(seen.rays.rays, 64 * occluded_side * occluded_side);
}

TEST_F(DeviceOcclusion, NothingIsInTheWayOfAnOpenPlane) {
  Scene scene = wall_on_ground(0);
  scene.occlusion = AmbientOcclusion{1e4f};
  const Occluded open = occluded(scene, occluded_options(4));
  EXPECT_EQ(open.rays.rays, 4 * occluded_side * occluded_side);
  EXPECT_EQ(open.rays.hits, 0u);
  for (const vec3& radiance : open.radiance) EXPECT_EQ(radiance, scene.ambient_light);
  EXPECT_EQ(open.radiance, occluded(scene, occluded_options(4), "-ambient_occlusion").radiance);
}

// In the corner of two half planes half of the light is kept off.
TEST_F(DeviceOcclusion, InTheCornerOfTwoHalfPlanesHalfIsLeft) {
  Scene scene = wall_on_ground(5e4f);
  scene.occlusion = AmbientOcclusion{1e30f};
  check_columns(scene, [](double) { return 0.5; });
}

// A wall of height h at distance d, seen under an angle whose cosine to the horizon is d / hypot(d, h).
TEST_F(DeviceOcclusion, AWallKeepsOffWhatItsHeightSays) {
  for (const double height : {0.5, 2.0}) {
    Scene scene = wall_on_ground(static_cast<float>(height));
    scene.occlusion = AmbientOcclusion{1e30f};
    check_columns(scene, [&](double d) { return 1 - (1 - d / std::hypot(d, height)) / 2; });
  }
}

// Within the distance D are the directions whose cosine to the wall's normal is at least c = d / D: of the
// disk below the hemisphere a segment.
TEST_F(DeviceOcclusion, BeyondTheDistanceNothingCounts) {
  constexpr double distance = 2;
  Scene scene = wall_on_ground(100);
  scene.occlusion = AmbientOcclusion{distance};
  check_columns(scene, [](double d) {
    const double c = d / distance;
    return c >= 1 ? 1 : 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / std::numbers::pi;
  });
}

TEST_F(DeviceOcclusion, TheDistanceIsAShareOfTheDiagonalWhereNothingIsSaid) {
  Scene scene = triangles_over_plane(50);
  const SceneArrays turned_on = scene_arrays(scene, effects_of(scene, EffectChanges("+ambient_occlusion")));
  const Aabb box = box_of(turned_on.triangles);
  EXPECT_FLOAT_EQ(turned_on.ambient.distance, 0.05f * glm::distance(box.box_min, box.box_max));
  scene.occlusion = AmbientOcclusion{};
  EXPECT_EQ(scene_arrays(scene).ambient.distance, turned_on.ambient.distance);
  scene.occlusion = AmbientOcclusion{0.25f};
  EXPECT_EQ(scene_arrays(scene).ambient.distance, 0.25f);
}

// What emits goes on doing so, and lights shine, wherever ambient light is kept off.
TEST_F(DeviceOcclusion, IsOfAmbientLightAlone) {
  Scene scene = wall_on_ground(5e4f);
  scene.occlusion = AmbientOcclusion{1e30f};
  scene.materials[0].emission = vec3(2);
  scene.materials[0].is_unlit = true;  // or it would be a light
  scene.light.direction = vec3(0, 1, 0);
  scene.light.radiance = vec3(4);
  const Occluded seen = occluded(scene, occluded_options(4)),
                 without = occluded(scene, occluded_options(4), "-ambient_occlusion");
  for (std::size_t i = 0; i < seen.radiance.size(); ++i) {
    EXPECT_GE(seen.radiance[i].x, 6);
    EXPECT_LE(seen.radiance[i].x, 6.5f);
    EXPECT_EQ(without.radiance[i].x, 6.5f);
  }
  EXPECT_EQ(without.rays.rays, 0u);
  scene.ambient_light = vec3(0);
  EXPECT_EQ(occluded(scene, occluded_options(4)).rays.rays, 0u) << "without ambient light there is none";
}

Scene occluded_triangles() {
  Scene scene = triangles_over_plane(300);
  scene.occlusion = AmbientOcclusion{1.5f};
  set_lights(scene, {{.is_point = true, .place = {0.5f, 3, 0.25f}, .radiance = {2, 1, 0.5f}, .origin = ""},
                     {.place = glm::normalize(vec3(1, 2, 3)), .shadows = true, .origin = ""}});
  return scene;
}

TEST_F(DeviceOcclusion, IsInLockstepWithTheTwins) {
  Scene scene = occluded_triangles();
  for (const Walk walk : {Walk::binary, Walk::wide_single}) {
    FrameOptions options = occluded_options(2, walk);
    options.trace.width = 31;  // no multiple of anything
    options.trace.height = 19;
    const SceneArrays arrays = scene_arrays(scene);
    Layout layout(test_device().properties().max_block_bytes);
    const FramePlan plan = plan_frame(layout, arrays, options);
    LockstepExecutor executor(test_device(), layout);
    upload_frame(executor, plan, arrays, make_film(scene, {}, 31, 19, 2));
    const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
    EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << " " << difference->index;
    const TraceCounts rays = counts_of(executor.cpu().read(plan.trace.lights.occlusion_counters)[0]);
    EXPECT_GT(rays.hits, 10u);
    EXPECT_LT(rays.hits, rays.rays);
    scene.more_lights.clear();
    scene.light.radiance = vec3(0);  // then ambient light is all there is
  }
}

TEST_F(DeviceOcclusion, IsTheSameThroughEveryTreeAndHoweverATraceIsCut) {
  const Scene scene = occluded_triangles();
  const Occluded whole = occluded(scene, occluded_options(2));
  for (const Walk walk : {Walk::wide_packets, Walk::wide_single}) {
    const Occluded other = occluded(scene, occluded_options(2, walk));
    EXPECT_EQ(other.radiance, whole.radiance) << name_of(walk);
    EXPECT_EQ(other.rays.hits, whole.rays.hits);
  }
  for (const std::uint64_t work : {1u, 500u}) {
    const Occluded cut = occluded(scene, occluded_options(2), "", work);
    EXPECT_EQ(cut.radiance, whole.radiance) << work;
    EXPECT_EQ(cut.image, whole.image);
    EXPECT_EQ(cut.rays.rays, whole.rays.rays);
    EXPECT_EQ(cut.rays.steps, whole.rays.steps);
  }
}

TEST_F(DeviceOcclusion, MovingFramesHaveThatOfTheirTrianglesWhereTheyStand) {
  Scene scene = all_that_moves(60);
  scene.occlusion = AmbientOcclusion{2};
  scene.lens.aperture = 0.1f;
  MovingOptions options = moving_options();
  options.trace.samples = 2;
  MovingFrames frames(test_device(), scene, options);
  const Film film = film_of(scene, options);
  frames.submit(0, film);
  const MovingFrame first = frames.take();
  const std::vector<uint> image(first.image.begin(), first.image.end());
  EXPECT_EQ(first.occlusion.rays, first.counts.hits);
  EXPECT_GT(first.occlusion.hits, 0u);
  Scene still = scene;  // of the triangles that the frame left
  still.motion = nullptr;
  still.positions.clear();
  for (const Triangle& t : frames.executor().read(frames.plan().tree.triangles))
    still.positions.insert(still.positions.end(), {t.a, t.b, t.c});
  EXPECT_EQ(image, still_picture(still, film, options.build, options.trace));
  options.effects = EffectChanges("-ambient_occlusion,-depth_of_field");
  MovingFrames plain(test_device(), scene, options);
  EXPECT_NE(frame_at(plain, 0, film), image);
}

}  // namespace
}  // namespace coppice
