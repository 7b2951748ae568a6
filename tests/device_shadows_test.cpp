// Lights and hard shadows on the device: every stage in lockstep with its twin, pictures against closed forms
// and against the plain light, the same bits through every tree and however a trace is cut.
#include <cmath>
#include <glm/geometric.hpp>

#include "pipeline/wide_plan.h"
#include "render/film.h"
#include "render/frame.h"
#include "scene/hard_cases.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/lit_scene.h"
#include "support/moving_frames.h"
#include "support/moving_scenes.h"
#include "support/test_device.h"
#include "support/traced_frame.h"

namespace coppice {
namespace {

using DeviceShadows = DeviceTest;

constexpr std::uint32_t picture_width = 72, picture_height = 54;

struct Pictured {
  std::vector<uint> image;
  TraceCounts camera, shadow;
};

FrameOptions frame_options(Walk walk = Walk::binary, std::uint32_t samples = 1) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(picture_width, picture_height)};
  options.trace.walk = walk;
  options.trace.samples = samples;
  return options;
}

Film film_for(const Scene& scene, const FrameOptions& options) {
  return make_film(scene, {}, options.trace.width, options.trace.height, options.trace.samples);
}

Pictured picture_of(const Scene& scene, const FrameOptions& options, const char* changes = "",
                    std::uint64_t work = ~std::uint64_t{0}) {
  const SceneArrays arrays = scene_arrays(scene, effects_of(scene, EffectChanges(changes)));
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  GpuExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, film_for(scene, options));
  trace_frame_in_pieces(executor, plan, work);
  Pictured pictured{executor.read(plan.trace.image), counts_of(executor.read(plan.trace.counters)[0]), {}};
  if (plan.trace.lights.counters.count > 0)
    pictured.shadow = counts_of(executor.read(plan.trace.lights.counters)[0]);
  return pictured;
}

// A square of side 2 that hovers at height 1 over a large plane, seen from above; the sun comes from
// (1, 2, 0.5).
Scene square_over_plane() {
  Scene scene;
  add_quad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
  add_quad(scene, {-1, 1, -1}, {0, 0, 2}, {2, 0, 0});
  scene.camera = Camera{.position = {3, 6, 5}, .target = {0, 0, 0}};
  scene.light.direction = glm::normalize(vec3(1, 2, 0.5f));
  scene.light.shadows = true;
  return scene;
}

// Where a ray of a pixel's centre meets the plane y = height.
glm::dvec3 point_seen(const Film& film, uint x, uint y, double height) {
  const glm::dvec3 direction =
      glm::dvec3(film.corner) + glm::dvec3(film.right) * (x + 0.5) + glm::dvec3(film.down) * (y + 0.5);
  return glm::dvec3(film.position) + direction * ((height - film.position.y) / direction.y);
}

// How far inside of a square of side 2 around `centre` a point is; negative outside.
double depth_inside(const glm::dvec3& point, const glm::dvec3& centre) {
  return 1 - std::max(std::abs(point.x - centre.x), std::abs(point.z - centre.z));
}

struct Checked {
  int lit = 0, dark = 0, wrong = 0;
};

// Every pixel of the plane is dark where `shadow_depth` of its point is positive, but for a border.
Checked check_shadow(const Pictured& pictured, const Film& film,
                     const std::function<double(const glm::dvec3&)>& shadow_depth) {
  Checked checked;
  for (uint y = 0; y < film.height; ++y) {
    for (uint x = 0; x < film.width; ++x) {
      if (depth_inside(point_seen(film, x, y, 1), {0, 1, 0}) > -1e-3) continue;  // the square hides the plane
      const double depth = shadow_depth(point_seen(film, x, y, 0));
      if (std::abs(depth) < 1e-3) continue;
      const uint pixel = pictured.image[y * film.width + x];
      // Ambient light alone is 0.35 * 0.7.
      const bool is_dark = (pixel & 255) < 140;
      ++(depth > 0 ? checked.dark : checked.lit);
      checked.wrong += is_dark != (depth > 0);
    }
  }
  return checked;
}

TEST_F(DeviceShadows, ASquareOverAPlaneCastsTheShadowThatItMust) {
  const Scene scene = square_over_plane();
  const Film film = film_for(scene, frame_options());
  const glm::dvec3 centre = -glm::dvec3(0.5, 0, 0.25);  // away from the sun by height / slope
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    const Pictured pictured = picture_of(scene, frame_options(walk));
    const Checked checked =
        check_shadow(pictured, film, [&](const glm::dvec3& point) { return depth_inside(point, centre); });
    EXPECT_EQ(checked.wrong, 0) << name_of(walk);
    EXPECT_GT(checked.dark, 50);
    EXPECT_GT(checked.lit, 1000);
    EXPECT_EQ(pictured.shadow.rays, pictured.camera.hits) << "all that is seen faces the sun";
    EXPECT_GT(pictured.shadow.hits, 50u);
  }
}

TEST_F(DeviceShadows, APointOfLightCastsAShadowLargerThanTheSquare) {
  Scene scene = square_over_plane();
  const vec3 lamp(0.25f, 3, -0.5f);
  set_lights(scene,
             {{.is_point = true, .place = lamp, .radiance = vec3(200), .shadows = true, .origin = ""}});
  const Film film = film_for(scene, frame_options());
  // Central projection from the lamp: the square at a third of the way grows by 3 / 2.
  const auto depth = [&](const glm::dvec3& point) {
    return depth_inside(glm::dvec3(lamp) + (point - glm::dvec3(lamp)) * (2.0 / 3), {0, 1, 0});
  };
  const Checked checked = check_shadow(picture_of(scene, frame_options()), film, depth);
  EXPECT_EQ(checked.wrong, 0);
  EXPECT_GT(checked.dark, 50);
  EXPECT_GT(checked.lit, 1000);
}

TEST_F(DeviceShadows, ALightBelowTheSquareLeavesThePlaneLitAndWhatIsBehindALightCastsNone) {
  Scene scene = square_over_plane();
  set_lights(scene, {{.is_point = true, .place = {0, 0.5f, 0}, .shadows = true, .origin = ""}});
  const Pictured pictured = picture_of(scene, frame_options());
  EXPECT_EQ(pictured.shadow.hits, 0u);
  EXPECT_GT(pictured.shadow.rays, 0u);
  EXPECT_LT(pictured.shadow.rays, pictured.camera.hits) << "the square shows its dark side to the lamp";
}

TEST_F(DeviceShadows, FollowTheInverseSquareOfThePointsDistance) {
  Scene scene = square_over_plane();
  scene.indices.resize(2);  // the plane alone
  scene.material_index.resize(2);
  scene.ambient_light = vec3(0);
  scene.materials[0].diffuse = vec3(1);
  const Film film = film_for(scene, frame_options());
  const uint x = picture_width / 2, y = picture_height / 2;
  const glm::dvec3 point = point_seen(film, x, y, 0);
  for (const auto& [height, radiance] :
       {std::pair(1.0f, 0.25f), {2.0f, 1.0f}, {4.0f, 1.0f}, {0.5f, 0.125f}}) {
    set_lights(scene,
               {{.is_point = true, .place = {0, height, 0}, .radiance = vec3(radiance), .origin = ""}});
    const double distance = glm::length(glm::dvec3(0, height, 0) - point);
    const double linear = radiance * height / std::pow(distance, 3);
    const double code = 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    const Pictured pictured = picture_of(scene, frame_options());
    EXPECT_NEAR(pictured.image[y * picture_width + x] & 255, code, 0.51) << height << " " << radiance;
  }
}

// Nothing is in the way of a light inside of a sphere's hollow, or of one that all triangles face: with
// shadows the picture has the bits of the plain one.
TEST_F(DeviceShadows, WhereNothingBlocksTheLightThePictureIsThePlainOne) {
  Scene scene;
  add_quad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
  scene.camera = Camera{.position = {3, 4, 5}, .target = {0, 0, 0}};
  const Pictured plain = picture_of(scene, frame_options());
  EXPECT_EQ(plain.shadow.rays, 0u);
  const Pictured shadowed = picture_of(scene, frame_options(), "+shadows");
  EXPECT_EQ(shadowed.shadow.rays, shadowed.camera.hits);
  EXPECT_EQ(shadowed.shadow.hits, 0u);
  EXPECT_EQ(plain.image, shadowed.image);
  EXPECT_EQ(plain.image, picture_of(scene, frame_options(), "+lights").image);
}

// No surface shades itself: a convex body is dark only where it faces away, which the plain light knows, too.
TEST_F(DeviceShadows, AConvexBodyCastsNoShadowOnItself) {
  for (const float scale : {1e-20f, 1.0f, 1e12f}) {
    Scene scene = find_hard_case("sphere")->make(3000, 1);
    for (vec3& position : scene.positions) position *= scale;
    bring_into_range(scene);
    const Pictured plain = picture_of(scene, frame_options(Walk::wide_packets));
    const Pictured shadowed = picture_of(scene, frame_options(Walk::wide_packets), "+shadows");
    EXPECT_EQ(shadowed.shadow.hits, 0u) << scale;
    EXPECT_LT(shadowed.shadow.rays, shadowed.camera.hits);
    EXPECT_EQ(plain.image, shadowed.image) << scale;
  }
}

Scene scene_with_all_lights() {
  Scene scene = triangles_over_plane(300);
  set_lights(scene, {{.is_point = true, .place = {0.5f, 3, 0.25f}, .radiance = {2, 1, 0.5f}, .origin = ""},
                     {.place = glm::normalize(vec3(1, 2, 3)), .shadows = true, .origin = ""},
                     {.place = {0, 1, 0}, .radiance = {0.25f, 0.5f, 1}, .origin = ""},
                     {.is_point = true, .place = {-2, 2, 2}, .shadows = true, .origin = ""}});
  return scene;
}

TEST_F(DeviceShadows, AreInLockstepWithTheTwins) {
  const Scene scene = scene_with_all_lights();
  for (const Walk walk : {Walk::binary, Walk::wide_single}) {
    FrameOptions options = frame_options(walk, 2);
    options.trace.width = 31;  // no multiple of anything
    options.trace.height = 19;
    const SceneArrays arrays = scene_arrays(scene);
    Layout layout(test_device().properties().max_block_bytes);
    const FramePlan plan = plan_frame(layout, arrays, options);
    LockstepExecutor executor(test_device(), layout);
    upload_frame(executor, plan, arrays, film_for(scene, options));
    const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
    EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << " " << difference->index
                             << ": " << difference->cpu << " and " << difference->gpu;
    const TraceCounts shadow = counts_of(executor.cpu().read(plan.trace.lights.counters)[0]);
    EXPECT_GT(shadow.rays, 100u);
    EXPECT_GT(shadow.hits, 10u);
    EXPECT_LT(shadow.hits, shadow.rays);
  }
}

TEST_F(DeviceShadows, AreTheSameThroughEveryTreeAndHoweverATraceIsCut) {
  const Scene scene = scene_with_all_lights();
  const Pictured whole = picture_of(scene, frame_options(Walk::binary, 2));
  for (const Walk walk : {Walk::wide_packets, Walk::wide_single}) {
    const Pictured other = picture_of(scene, frame_options(walk, 2));
    EXPECT_EQ(other.image, whole.image) << name_of(walk);
    EXPECT_EQ(other.shadow.rays, whole.shadow.rays);
    EXPECT_EQ(other.shadow.hits, whole.shadow.hits);
  }
  for (const std::uint64_t work : {1u, 500u, 3000u}) {
    const Pictured cut = picture_of(scene, frame_options(Walk::binary, 2), "", work);
    EXPECT_EQ(cut.image, whole.image) << work;
    EXPECT_EQ(cut.shadow.rays, whole.shadow.rays);
    EXPECT_EQ(cut.shadow.hits, whole.shadow.hits);
    EXPECT_EQ(cut.shadow.steps, whole.shadow.steps);
  }
}

TEST_F(DeviceShadows, MovingFramesHaveThoseOfTheirTrianglesWhereTheyStand) {
  Scene scene = all_that_moves(60);
  scene.light.shadows = true;
  MovingOptions options = moving_options();
  MovingFrames frames(test_device(), scene, options);
  const Film film = film_of(scene, options);
  frames.submit(0, film);
  const MovingFrame first = frames.take();
  const std::vector<uint> image(first.image.begin(), first.image.end());
  EXPECT_GT(first.shadow.rays, 0u);
  EXPECT_LE(first.shadow.rays, first.counts.hits);
  Scene still = scene;  // of the triangles that the frame left
  still.motion = nullptr;
  still.positions.clear();
  for (const Triangle& t : frames.executor().read(frames.plan().tree.triangles))
    still.positions.insert(still.positions.end(), {t.a, t.b, t.c});
  EXPECT_EQ(image, still_picture(still, film, options.build, options.trace));
  EXPECT_NE(frame_at(frames, 0.7, film), image);
  options.effects = EffectChanges("-shadows");
  MovingFrames plain(test_device(), scene, options);
  plain.submit(0, film);
  EXPECT_EQ(plain.take().shadow.rays, 0u);
}

}  // namespace
}  // namespace coppice
