// Pictures that are refined pass by pass: the same bits however many samples a pass has, each stage in
// lockstep with its twin, and an estimate of the error that is what it says.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/refine.h"
#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "stages/lockstep_executor.h"
#include "support/lit_scene.h"
#include "support/test_device.h"

namespace coppice {
namespace {

using DeviceRefine = DeviceTest;

constexpr std::uint32_t refined_width = 72, refined_height = 54;
constexpr std::uint64_t refined_pixels = refined_width * refined_height;

struct RefinedPicture {
  std::vector<vec3> radiance;
  std::vector<LuminanceSums> luminance;
  std::vector<uint> image;
  TraceCounts counts, shadow;
  double error = 0;
};

// The sun and a lamp, both of which cast shadows: radiance comes in three parts.
Scene twice_lit_scene() {
  Scene scene = triangles_over_plane(200);
  scene.light.shadows = true;
  scene.more_lights.push_back({.is_point = true, .place = {1, 3, 2}, .shadows = true, .origin = ""});
  return scene;
}

// Up to each of these numbers of samples in a pass.
RefinedPicture refined(const Scene& scene, const std::vector<std::uint32_t>& ends) {
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(refined_width, refined_height)};
  options.trace.keep_noise = true;
  const SceneArrays arrays = scene_arrays(scene);
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  GpuExecutor executor(test_device(), layout);
  Film film = make_film(scene, {}, refined_width, refined_height, ends.back());
  film.is_sequence = 1;
  upload_frame(executor, plan, arrays, film);
  Chain build = executor.chain();
  append_frame_build(build, plan);
  executor.record(build.steps()).submit_and_wait(submit_limit_seconds);
  std::uint32_t first = 0;
  for (const std::uint32_t end : ends) {
    for (TracePieces pieces = plan.pieces(plan_of_pass(plan.trace, first, end)); !pieces.done();) {
      Chain chain = executor.chain();
      pieces.append(chain, 20000);
      executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    }
    first = end;
  }
  Chain chain = executor.chain();
  if (first >= 2) append_noise_sum(chain, plan.trace.noise, first);
  append_resolved(chain, plan.trace);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  const float sum = first >= 2 ? executor.read(noise_sum_of(plan.trace.noise))[0] : 0;
  return {executor.read(plan.trace.radiance),
          executor.read(plan.trace.noise.luminance),
          executor.read(plan.trace.image),
          counts_of(executor.read(plan.trace.counters)[0]),
          counts_of(executor.read(plan.trace.lights.counters)[0]),
          picture_error(sum, refined_pixels)};
}

double luminance_in_double(vec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// --- What is promised.

TEST_F(DeviceRefine, AnyPassesOfAsManySamplesGiveTheSameBits) {
  const Scene scene = twice_lit_scene();
  const RefinedPicture whole = refined(scene, {13});
  EXPECT_EQ(whole.counts.rays, 13 * refined_pixels);
  EXPECT_GT(whole.shadow.hits, 0u);
  for (const std::vector<std::uint32_t>& ends : {std::vector<std::uint32_t>{1, 2, 13}, {5, 10, 13}}) {
    const RefinedPicture parts = refined(scene, ends);
    EXPECT_EQ(parts.radiance, whole.radiance);
    EXPECT_EQ(parts.image, whole.image);
    EXPECT_EQ(parts.error, whole.error);
    EXPECT_EQ(parts.counts.rays, whole.counts.rays);
    EXPECT_EQ(parts.counts.hits, whole.counts.hits);
    EXPECT_EQ(parts.shadow.rays, whole.shadow.rays);
    EXPECT_EQ(parts.shadow.hits, whole.shadow.hits);
  }
}

TEST_F(DeviceRefine, EveryStageIsThatOfItsTwin) {
  const Scene scene = twice_lit_scene();
  const SceneArrays arrays = scene_arrays(scene);
  for (const std::uint32_t samples : {2u, 3u}) {
    FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(refined_width, refined_height)};
    options.trace.keep_noise = true;
    options.trace.samples = samples;
    Layout layout(test_device().properties().max_block_bytes);
    const FramePlan plan = plan_frame(layout, arrays, options);
    LockstepExecutor executor(test_device(), layout);
    Film film = make_film(scene, {}, refined_width, refined_height, samples);
    film.is_sequence = 1;
    upload_frame(executor, plan, arrays, film);
    const auto difference = executor.run([&](Chain& chain) {
      append_frame_build(chain, plan);
      append_trace(chain, plan.tree, plan_of_pass(plan.trace, 0, samples));
      append_noise_sum(chain, plan.trace.noise, samples);
      append_resolved(chain, plan.trace);
    });
    EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                             << "]\ncpu " << difference->cpu << "\ngpu " << difference->gpu;
  }
}

// Every third pixel, the last first, has two more samples than the others: each has the bits of a picture of
// as many, by kernels and twins.
TEST_F(DeviceRefine, PixelsOfAListHaveTheSamplesThatAllWouldHave) {
  const Scene scene = twice_lit_scene();
  const SceneArrays arrays = scene_arrays(scene);
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(refined_width, refined_height)};
  options.trace.keep_noise = options.trace.adaptive = true;
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  const NoiseSlots& noise = plan.trace.noise;
  LockstepExecutor executor(test_device(), layout);
  Film film = make_film(scene, {}, refined_width, refined_height, 4);
  film.is_sequence = 1;
  upload_frame(executor, plan, arrays, film);
  std::vector<uint> list;
  for (uint pixel = refined_pixels; pixel-- > 0;) {
    if (pixel % 3 == 0) list.push_back(pixel);
  }
  executor.upload({noise.pixels.place, list.size()}, std::span<const uint>(list));
  const auto difference = executor.run([&](Chain& chain) {
    append_frame_build(chain, plan);
    append_trace(chain, plan.tree, plan_of_pass(plan.trace, 0, 2));
    TracePlan some = plan_of_pass(plan.trace, 2, 4);
    some.traced_pixels = {noise.pixels.place, list.size()};
    append_trace(chain, plan.tree, some);
    append_noise_sum(chain, noise, 4);
    append_resolved(chain, plan.trace);
    append_active_pixels(chain, noise, plan.tree.state, 0.02);
  });
  ASSERT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                           << "]\ncpu " << difference->cpu << "\ngpu " << difference->gpu;
  const RefinedPicture two = refined(scene, {2}), four = refined(scene, {4});
  const auto radiance = executor.gpu().read(plan.trace.radiance);
  const auto counts = executor.gpu().read(noise.sample_counts);
  const auto means = mean_radiance(radiance, refined_width, refined_height, 0, counts);
  const auto means_of_two = mean_radiance(two.radiance, refined_width, refined_height, 2);
  const auto means_of_four = mean_radiance(four.radiance, refined_width, refined_height, 4);
  const auto image = executor.gpu().read(plan.trace.image);
  for (uint i = 0; i < refined_pixels; ++i) {
    EXPECT_EQ(counts[i], i % 3 == 0 ? 4u : 2u);
    EXPECT_EQ(radiance[i], (i % 3 == 0 ? four : two).radiance[i]) << i;
    EXPECT_TRUE((image[i] == two.image[i] && means[i] == means_of_two[i]) ||
                (image[i] == four.image[i] && means[i] == means_of_four[i]))
        << i;
  }
  // What is left to do are those beyond the limit, in their order.
  std::vector<uint> active = executor.gpu().read(noise.pixels);
  active.resize(executor.gpu().read(noise.active_count)[0]);
  EXPECT_TRUE(std::ranges::is_sorted(active));
  EXPECT_GT(active.size(), 100u);
  EXPECT_LT(active.size(), refined_pixels / 2);
}

// From the radiance of each sample, in double.
TEST_F(DeviceRefine, TheErrorIsThatOfItsDefinition) {
  constexpr std::uint32_t samples = 9;
  const Scene scene = twice_lit_scene();
  std::vector<std::vector<double>> of_samples;  // differences of sums
  std::vector<double> before(refined_pixels, 0);
  std::vector<std::uint32_t> ends;
  double error = 0;
  for (std::uint32_t end = 1; end <= samples; ++end) {
    ends.push_back(end);
    const RefinedPicture picture = refined(scene, ends);
    error = picture.error;
    std::vector<double>& now = of_samples.emplace_back();
    for (std::size_t i = 0; i < refined_pixels; ++i) {
      const double sum = luminance_in_double(picture.radiance[i]);
      now.push_back(sum - before[i]);
      before[i] = sum;
    }
  }
  double total = 0;
  for (std::size_t i = 0; i < refined_pixels; ++i) {
    const double mean = before[i] / samples;
    double squares = 0;
    for (const auto& sample : of_samples) squares += (sample[i] - mean) * (sample[i] - mean);
    total += squares / (samples - 1) / samples / (mean * mean + NOISE_DARK);
  }
  const double expected = std::sqrt(total / refined_pixels);
  EXPECT_GT(expected, 0.01);
  EXPECT_NEAR(error, expected, 1e-3 * expected);
}

// Against as good as the limit. Samples of a sequence are spread more evenly than the estimate takes them to
// be, so the error is less; not by an order of magnitude.
TEST_F(DeviceRefine, TheErrorIsAboutWhatItIsEstimatedToBe) {
  const Scene scene = twice_lit_scene();
  const RefinedPicture picture = refined(scene, {32}), limit = refined(scene, {512});
  double total = 0;
  for (std::size_t i = 0; i < refined_pixels; ++i) {
    const double mean = luminance_in_double(picture.radiance[i]) / 32,
                 truth = luminance_in_double(limit.radiance[i]) / 512;
    total += (mean - truth) * (mean - truth) / (truth * truth + NOISE_DARK);
  }
  const double error = std::sqrt(total / refined_pixels);
  EXPECT_LT(error, 1.1 * picture.error);
  EXPECT_GT(error, picture.error / 10);
  EXPECT_LT(limit.error, picture.error / 3);
}

TEST_F(DeviceRefine, PixelsThatAreNoNumberLeaveTheErrorOfTheOthers) {
  Layout layout(test_device().properties().max_block_bytes);
  constexpr std::uint32_t count = NOISE_SUM_RUN * NOISE_SUM_RUN + 5;  // three levels
  const NoiseSlots slots = plan_noise(layout, 1, count, false);
  constexpr float inf = std::numeric_limits<float>::infinity();
  std::vector<LuminanceSums> luminance(count, {0.5f, 0, 0.25f});  // two samples: variance 0.25 of each
  luminance[3] = {inf, std::nanf(""), std::nanf("")};
  luminance[70] = {std::nanf(""), 0, 1};
  luminance[900] = {1, 0, inf};
  luminance[901] = {1, 0, -1};
  LockstepExecutor executor(test_device(), layout);
  executor.upload(slots.luminance, std::span<const LuminanceSums>(luminance));
  const auto difference = executor.run([&](Chain& chain) { append_noise_sum(chain, slots, 2); });
  EXPECT_FALSE(difference) << difference->slot << "[" << difference->index << "]";
  const double sum = executor.gpu().read(noise_sum_of(slots))[0];
  EXPECT_NEAR(sum, NOISE_MOST + (count - 4) * 0.125 / (0.25 + NOISE_DARK), 0.5);
}

}  // namespace
}  // namespace coppice
