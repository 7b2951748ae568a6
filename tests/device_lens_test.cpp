// Depth of field: the blur of a thin lens against closed forms, what is in focus and an aperture of 0 against
// the pinhole, and the stage in lockstep with its twin.
#include <cmath>
#include <numbers>

#include "render/film.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/lit_scene.h"
#include "support/test_device.h"

namespace coppice {
namespace {

using DeviceLens = DeviceTest;

constexpr std::uint32_t lens_side = 40;           // of a picture, in pixels
constexpr double lens_depth = 4, lens_focus = 8;  // of what is seen, and where it would be sharp
const double lens_pixel = 2 * std::tan(20 * std::numbers::pi / 180) / lens_side;  // at depth 1

// A rectangle that glows, in front of a camera at the origin that looks along -z, and nothing else but black.
Scene glowing(double depth, double left, double right, double bottom, double top) {
  Scene scene;
  const auto z = static_cast<float>(-depth);
  add_quad(scene, vec3(left, bottom, z), vec3(right - left, 0, 0), vec3(0, top - bottom, 0));
  scene.materials[0].diffuse = vec3(0);
  scene.materials[0].emission = vec3(1);
  scene.camera = Camera{.position = {0, 0, 0}, .target = {0, 0, -lens_focus}};
  return scene;
}

// The diameter of a lens through which a point at that depth is a disk of so many pixels' radius.
double aperture_for(double pixels, double depth) {
  return 2 * pixels * lens_pixel / std::abs(1 / depth - 1 / lens_focus);
}

struct Seen {
  std::vector<vec3> radiance;
  std::vector<uint> image;
};

Seen seen_of(const Scene& scene, std::uint32_t samples, bool lens, bool sequence = false) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(lens_side, lens_side)};
  options.trace.samples = samples;
  options.trace.keep_radiance = true;
  SceneArrays arrays = scene_arrays(scene);
  arrays.lighting.sky_horizon = arrays.lighting.sky_zenith = vec3(0);
  arrays.lens = lens;
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  GpuExecutor executor(test_device(), layout);
  Film film = make_film(scene, {}, lens_side, lens_side, samples);
  film.is_sequence = sequence;
  upload_frame(executor, plan, arrays, film);
  Chain chain = executor.chain();
  append_frame(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  return {mean_radiance(executor.read(plan.trace.radiance), lens_side, lens_side, samples),
          executor.read(plan.trace.image)};
}

// A point of light at depth z is a disk: of R |1/z - 1/f| at depth 1, R the radius of the lens and f the
// depth that is in focus; evenly bright, with all the light that the pinhole has of it.
TEST_F(DeviceLens, ASmallLightOutOfFocusIsAnEvenDiskOfTheCircleOfConfusion) {
  for (const auto& [depth, pixels] : {std::pair(lens_depth, 12.0), {lens_depth, 6.0}, {20.0, 9.0}}) {
    const double half = 1.5 * lens_pixel * depth;  // three pixels wide
    Scene scene = glowing(depth, -half, half, -half, half);
    scene.lens.aperture = static_cast<float>(aperture_for(pixels, depth));
    scene.lens.focus = static_cast<float>(lens_focus);
    double light = 0, square = 0, inner = 0, outside = 0;
    const Seen seen = seen_of(scene, 256, true);
    for (std::uint32_t y = 0; y < lens_side; ++y) {
      for (std::uint32_t x = 0; x < lens_side; ++x) {
        const double value = seen.radiance[y * lens_side + x].x;
        const double distance = std::hypot(x + 0.5 - lens_side / 2.0, y + 0.5 - lens_side / 2.0);
        light += value;
        square += value * distance * distance;
        if (distance < pixels / 2) inner += value;
        if (distance > pixels + 3) outside += value;
      }
    }
    EXPECT_NEAR(light, 9, 0.25) << "as through a pinhole";
    EXPECT_EQ(outside, 0);
    // Of a disk half the square of its radius; of a square a sixth of that of its side, as the pixel's.
    EXPECT_NEAR(square / light, pixels * pixels / 2 + 9.0 / 6, 0.04 * pixels * pixels) << depth;
    EXPECT_NEAR(inner / light, 0.25, 0.04) << depth;
  }
}

// The part of a disk on one side of a line at s radii from its centre.
double part_of_disk(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 1 - (std::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
}

TEST_F(DeviceLens, AnEdgeOutOfFocusFadesAsTheDiskIsCut) {
  constexpr double pixels = 8;
  Scene scene = glowing(lens_depth, -30, 0, -30, 30);
  scene.lens.aperture = static_cast<float>(aperture_for(pixels, lens_depth));  // focus: the camera's target
  const Seen seen = seen_of(scene, 64, true);
  for (std::uint32_t x = 0; x < lens_side; ++x) {
    double mean = 0;
    for (std::uint32_t y = 0; y < lens_side; ++y) mean += seen.radiance[y * lens_side + x].x / lens_side;
    EXPECT_NEAR(mean, part_of_disk((lens_side / 2.0 - (x + 0.5)) / pixels), 0.02) << x;
  }
}

TEST_F(DeviceLens, WhatIsInFocusIsSharp) {
  const double half = 7.3 * lens_pixel * lens_focus;
  Scene scene = glowing(lens_focus, -half, half, -half, half);
  scene.lens = {.aperture = 3, .focus = static_cast<float>(lens_focus), .origin = ""};
  for (const bool sequence : {false, true}) {
    const Seen sharp = seen_of(scene, 16, true, sequence), pinhole = seen_of(scene, 16, false, sequence);
    EXPECT_EQ(sharp.image, pinhole.image);
  }
  scene.lens.focus = 6;
  EXPECT_NE(seen_of(scene, 16, true).image, seen_of(scene, 16, false).image);
}

TEST_F(DeviceLens, AnApertureOf0GivesTheBitsOfThePinhole) {
  Scene scene = triangles_over_plane(200);
  const Seen pinhole = seen_of(scene, 3, false);
  EXPECT_EQ(seen_of(scene, 3, true).radiance, pinhole.radiance);
  scene.lens.aperture = 0.5f;
  EXPECT_EQ(seen_of(scene, 3, false).radiance, pinhole.radiance) << "which is not asked for";
  EXPECT_NE(seen_of(scene, 3, true).radiance, pinhole.radiance);
}

TEST_F(DeviceLens, RaysAreThoseOfTheTwin) {
  Scene scene = triangles_over_plane(100);
  scene.lens = {.aperture = 0.7f, .focus = 2.5f, .origin = ""};
  for (const bool adaptive : {false, true}) {
    FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(31, 19)};
    options.trace.samples = 5;
    options.trace.keep_noise = options.trace.adaptive = adaptive;
    const SceneArrays arrays = scene_arrays(scene);
    ASSERT_TRUE(arrays.lens);
    Layout layout(test_device().properties().max_block_bytes);
    FramePlan plan = plan_frame(layout, arrays, options);
    LockstepExecutor executor(test_device(), layout);
    Film film = make_film(scene, {}, 31, 19, 5);
    film.is_sequence = adaptive;
    upload_frame(executor, plan, arrays, film);
    std::vector<uint> some;  // of pixels
    for (uint i = 0; i < 31 * 19; i += 3) some.push_back(i);
    if (adaptive) executor.upload(plan.trace.noise.pixels, std::span<const uint>(some));
    if (adaptive) plan.trace.traced_pixels = {plan.trace.noise.pixels.place, some.size()};
    const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
    EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << " " << difference->index;
  }
}

}  // namespace
}  // namespace coppice
