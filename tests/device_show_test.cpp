// What is shown in place of colours: every view on the device as by its twin, and as an independent tracer in
// double sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "analysis/cpu_tracer.h"
#include "builders/ploc.h"
#include "measure/show_frame.h"
#include "render/frame.h"
#include "render/show.h"
#include "scene/generators.h"
#include "scene/hard_cases.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {
namespace {

constexpr std::uint32_t show_width = 67, show_height = 45, show_rays = show_width * show_height;

class ShowViews : public DeviceTest {};

struct Shown {
  std::vector<uint> image, steps, order;
  std::vector<Ray> rays;
  std::vector<Hit> hits;  // of the last sample, a ray a pixel in the order of FILM_STRIP
  std::vector<Node> nodes;
  std::vector<PlocRound> rounds;
  TraceCounts counts;
  ShowSpan span, seen;
};

struct ShownFrame {
  Show show;
  Walk walk = Walk::binary;
  std::uint32_t samples = 1;
};

// Build and trace by kernels and twins.
Shown show_in_lockstep(const Scene& scene, const ShownFrame& frame) {
  const SceneArrays arrays = scene_arrays(scene);
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(show_width, show_height)};
  options.trace.walk = frame.walk;
  options.trace.samples = frame.samples;
  options.trace.show = kernel_view(frame.show);
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  LockstepExecutor executor(test_device(), layout);
  const Film film = make_film(scene, {}, show_width, show_height, frame.samples);
  upload_frame(executor, plan.tree, plan.trace, arrays, film);
  Shown shown;
  shown.span =
      span_of({.show = frame.show}, film, box_of(arrays.triangles), frame.walk, arrays.triangle_count());
  upload_show(executor, plan.trace.show, frame.show, shown.span);
  if (plan.trace.show.primitive_values.count > 0) {
    std::vector<uint> values(arrays.triangles.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<uint>(i * 7 % values.size());
    executor.upload(plan.trace.show.primitive_values, std::span<const uint>(values));
  }
  const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
  EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                           << "]: cpu " << difference->cpu << ", gpu " << difference->gpu;
  const GpuExecutor& gpu = executor.gpu();
  shown.image = gpu.read(plan.trace.image);
  if (plan.trace.ray_steps.count > 0) shown.steps = gpu.read(plan.trace.ray_steps);
  shown.order = gpu.read(plan.build->values[0]);
  shown.rays = gpu.read(plan.trace.rays);
  shown.hits = gpu.read(plan.trace.hits);
  shown.nodes = gpu.read(plan.tree.nodes);
  shown.rounds = gpu.read(plan.build->rounds);
  shown.counts = counts_of(gpu.read(plan.trace.counters)[0]);
  if (plan.trace.show.range.count > 0) shown.seen = seen_in(gpu.read(plan.trace.show.range)[0], frame.show);
  return shown;
}

uint shown_pixel(const Shown& shown, std::size_t ray) {
  const std::size_t strip = ray / (FILM_STRIP * show_width), in_strip = ray - strip * FILM_STRIP * show_width;
  const std::size_t rows = std::min<std::size_t>(FILM_STRIP, show_height - strip * FILM_STRIP);
  return shown.image[(strip * FILM_STRIP + in_strip % rows) * show_width + in_strip / rows];
}

int code_of_linear(double linear) {
  const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * encoded));
}

// Each channel at most one code off.
void expect_codes_near(uint pixel, const std::array<int, 3>& codes, std::size_t ray) {
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(static_cast<int>(pixel >> (8 * channel) & 255), codes[channel], 1) << "ray " << ray;
}

// Hits by the independent tracer, through a tree of the independent builder.
std::vector<Hit> hits_in_double(const Scene& scene, std::vector<Ray>& rays) {
  const SceneArrays arrays = scene_arrays(scene);
  rays = rays_through(make_film(scene, {}, show_width, show_height, 1));
  std::vector<Hit> hits(rays.size());
  trace_all(build_ploc(arrays.triangles, {}).nodes, arrays.triangles, rays, hits);
  return hits;
}

Scene show_scene() { return find_hard_case("sphere")->make(1500, 3); }

TEST_F(ShowViews, EveryViewThroughEveryTreeIsAsByItsTwin) {
  const Scene scene = find_hard_case("nested")->make(1200, 1);
  for (const Show show : {Show::steps, Show::normals, Show::depth, Show::ids, Show::morton, Show::clusters})
    show_in_lockstep(scene, {show, Walk::binary, 2});
  for (const Walk walk : {Walk::wide_packets, Walk::wide_single})
    show_in_lockstep(scene, {Show::steps, walk, 2});
  show_in_lockstep(scene, {Show::depth, Walk::brute_force});
}

TEST_F(ShowViews, StepsOfRaysAddUpToWhatIsCounted) {
  for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
    const Shown shown = show_in_lockstep(show_scene(), {Show::steps, walk});
    std::uint64_t sum = 0;
    for (const uint steps : shown.steps) sum += steps;
    EXPECT_EQ(sum, shown.counts.steps) << name_of(walk);
    EXPECT_GT(sum, show_rays) << name_of(walk);
    const auto [least, greatest] = std::ranges::minmax_element(shown.steps);
    EXPECT_LT(*least, *greatest);
    EXPECT_EQ(shown.seen.least, static_cast<float>(*least)) << name_of(walk);
    EXPECT_EQ(shown.seen.greatest, static_cast<float>(*greatest)) << name_of(walk);
    for (std::size_t ray = 0; ray < shown.steps.size(); ++ray) {
      if (walk == Walk::wide_packets) {
        EXPECT_EQ(shown.steps[ray], shown.steps[ray / TRACE_PACKET * TRACE_PACKET]);
      }
      const double at = std::min(shown.steps[ray] * 256.0 / shown.span.greatest, 255.0);
      const auto code = turbo_code(std::floor(at) / 255);
      EXPECT_EQ(shown_pixel(shown, ray), 0xff000000u | uint{code[2]} << 16 | uint{code[1]} << 8 | code[0]);
    }
  }
}

TEST_F(ShowViews, DepthsAndNormalsAreThoseOfTheIndependentTracer) {
  const Scene scene = show_scene();
  const Film film = make_film(scene, {}, show_width, show_height, 1);
  const glm::dvec3 forward = glm::dvec3(film.corner) + glm::dvec3(film.right) * (show_width / 2.0) +
                             glm::dvec3(film.down) * (show_height / 2.0);
  EXPECT_NEAR(glm::length(forward), 1, 1e-6);
  std::vector<Ray> rays;
  const std::vector<Hit> hits = hits_in_double(scene, rays);
  const std::vector<Triangle> triangles = scene_arrays(scene).triangles;
  const Shown depth = show_in_lockstep(scene, {Show::depth}),
              normals = show_in_lockstep(scene, {Show::normals});
  double nearest = 1e30, farthest = 0;
  for (std::size_t ray = 0; ray < hits.size(); ++ray) {
    if (hits[ray].triangle == NO_TRIANGLE) {
      expect_codes_near(
          shown_pixel(depth, ray),
          {code_of_linear(SHOW_NOTHING), code_of_linear(SHOW_NOTHING), code_of_linear(SHOW_NOTHING)}, ray);
      continue;
    }
    const Triangle& triangle = triangles[hits[ray].triangle];
    const glm::dvec3 at = glm::dvec3(triangle.a) * (1.0 - hits[ray].u - hits[ray].v) +
                          glm::dvec3(triangle.b) * double{hits[ray].u} +
                          glm::dvec3(triangle.c) * double{hits[ray].v};
    const double along = glm::dot(at - glm::dvec3(film.position), forward);
    nearest = std::min(nearest, along);
    farthest = std::max(farthest, along);
    const double place = (along - depth.span.least) / (depth.span.greatest - depth.span.least) * 256;
    if (std::abs(place - std::round(place)) > 1e-3) {
      const auto code = viridis_code(1 - std::floor(std::min(place, 255.0)) / 255);
      expect_codes_near(shown_pixel(depth, ray), {code[0], code[1], code[2]}, ray);
    }
    const glm::dvec3 normal =
        glm::normalize(glm::cross(glm::dvec3(triangle.b - triangle.a), glm::dvec3(triangle.c - triangle.a)));
    const glm::dvec3 seen = normal * 0.5 + 0.5;
    expect_codes_near(
        shown_pixel(normals, ray),
        {code_of_linear(seen.x * seen.x), code_of_linear(seen.y * seen.y), code_of_linear(seen.z * seen.z)},
        ray);
  }
  EXPECT_NEAR(depth.seen.least, nearest, 1e-5 * farthest);
  EXPECT_NEAR(depth.seen.greatest, farthest, 1e-5 * farthest);
  EXPECT_LE(depth.span.least, nearest);
  EXPECT_GE(depth.span.greatest, farthest);
}

// Of the independent tracer's hits: pixels of one triangle have one colour, and other triangles others.
TEST_F(ShowViews, TrianglesHaveAColourEach) {
  const Scene scene = show_scene();
  std::vector<Ray> rays;
  const std::vector<Hit> hits = hits_in_double(scene, rays);
  const Shown shown = show_in_lockstep(scene, {Show::ids});
  std::map<uint, uint> triangle_of_colour, colour_of_triangle;
  for (std::size_t ray = 0; ray < hits.size(); ++ray) {
    const uint pixel = shown_pixel(shown, ray), triangle = hits[ray].triangle;
    EXPECT_EQ(colour_of_triangle.try_emplace(triangle, pixel).first->second, pixel);
    triangle_of_colour.try_emplace(pixel, triangle);
  }
  EXPECT_GT(colour_of_triangle.size(), 100u);
  EXPECT_GE(triangle_of_colour.size() + 2, colour_of_triangle.size());
}

TEST_F(ShowViews, MortonOrderIsThatOfTheDevicesSort) {
  const Scene scene = show_scene();
  const std::vector<Triangle> triangles = scene_arrays(scene).triangles;
  const Shown shown = show_in_lockstep(scene, {Show::morton});
  EXPECT_EQ(shown_values({.show = Show::morton}, triangles, 30, {}),
            ranks_in(shown.order, static_cast<std::uint32_t>(triangles.size())));
}

// After each round as many clusters as the build counted, each a union of some of the round before.
TEST_F(ShowViews, ClustersGrowFromTrianglesIntoTheTree) {
  const Scene scene = find_hard_case("scatter") ? find_hard_case("scatter")->make(3000, 1) : show_scene();
  const Shown shown = show_in_lockstep(scene, {Show::clusters});
  const auto count = static_cast<std::uint32_t>(scene.indices.size());
  std::vector<uint> before(count);
  for (uint i = 0; i < count; ++i) before[i] = i;
  std::uint32_t round = 0;
  for (;; ++round) {
    ASSERT_LT(round, shown.rounds.size());
    const std::vector<uint> clusters =
        clusters_of(shown.nodes, count, merges_after(shown.rounds, count, round));
    EXPECT_EQ(count_groups(clusters, shown.nodes), shown.rounds[round].cluster_count) << "round " << round;
    std::map<uint, uint> grown;
    for (uint i = 0; i < count; ++i)
      ASSERT_EQ(grown.try_emplace(before[i], clusters[i]).first->second, clusters[i]) << "round " << round;
    if (round == 0) {
      EXPECT_EQ(clusters, before);
    }
    before = clusters;
    if (shown.rounds[round].cluster_count == 1) break;
  }
  EXPECT_GT(round, 5u);
  EXPECT_EQ(merges_after(shown.rounds, count, 1000000), count - 1);
}

}  // namespace
}  // namespace coppice
