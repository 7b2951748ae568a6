// What is shown of scenes with instances: every view on the device as by its twin.
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

#include "measure/show_frame.h"
#include "render/frame.h"
#include "render/show.h"
#include "scene/instances.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {
namespace {

constexpr std::uint32_t seen_width = 53, seen_height = 37, seen_rays = seen_width * seen_height;

using ShowInstances = DeviceTest;

struct SeenInstances {
  std::vector<uint> image, instances, steps;
  TraceCounts counts;
};

// Build and trace by kernels and twins; of ranks and clusters every instance has a word of its own.
SeenInstances seen_in_lockstep(const Scene& scene, Show show, std::uint32_t samples = 1) {
  const SceneArrays arrays = scene_arrays(scene);
  FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(seen_width, seen_height)};
  options.trace.samples = samples;
  options.trace.show = kernel_view(show);
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, options);
  LockstepExecutor executor(test_device(), layout);
  const Film film = make_film(scene, {}, seen_width, seen_height, samples);
  upload_frame(executor, plan, arrays, film);
  const Aabb box = box_of_scene(make_instances(60), scene_arrays(make_instances(60)));
  upload_show(executor, plan.trace.show, show,
              span_of({.show = show}, film, box, Walk::binary, arrays.primitive_count()));
  if (plan.trace.show.primitive_values.count > 0) {
    EXPECT_EQ(plan.trace.show.primitive_values.count, arrays.primitive_count());
    std::vector<uint> values(arrays.primitive_count());
    std::iota(values.rbegin(), values.rend(), 0u);
    executor.upload(plan.trace.show.primitive_values, std::span<const uint>(values));
  }
  const auto difference = executor.run([&](Chain& chain) { append_frame(chain, plan); });
  EXPECT_FALSE(difference) << difference->stage << " " << difference->slot << "[" << difference->index
                           << "]: cpu " << difference->cpu << ", gpu " << difference->gpu;
  SeenInstances seen{
      executor.gpu().read(plan.trace.image), {}, {}, counts_of(executor.gpu().read(plan.trace.counters)[0])};
  if (plan.levels) seen.instances = executor.gpu().read(plan.levels->hits.hit_instances);
  if (plan.trace.ray_steps.count > 0) seen.steps = executor.gpu().read(plan.trace.ray_steps);
  return seen;
}

uint pixel_of_ray(const std::vector<uint>& image, std::size_t ray) {
  const std::size_t strip = ray / (FILM_STRIP * seen_width), in_strip = ray - strip * FILM_STRIP * seen_width;
  const std::size_t rows = std::min<std::size_t>(FILM_STRIP, seen_height - strip * FILM_STRIP);
  return image[(strip * FILM_STRIP + in_strip % rows) * seen_width + in_strip / rows];
}

TEST_F(ShowInstances, EveryViewIsAsByItsTwin) {
  const Scene scene = make_instances(60);
  std::set<std::vector<uint>> pictures;
  for (const Show show :
       {Show::steps, Show::normals, Show::depth, Show::ids, Show::morton, Show::clusters, Show::instances})
    EXPECT_TRUE(pictures.insert(seen_in_lockstep(scene, show, 2).image).second) << name_of(show);
}

TEST_F(ShowInstances, EachHasAColour) {
  const SeenInstances seen = seen_in_lockstep(make_instances(60), Show::instances);
  std::map<uint, uint> colour_of, instance_of;
  for (std::size_t ray = 0; ray < seen_rays; ++ray) {
    const uint colour = pixel_of_ray(seen.image, ray), instance = seen.instances[ray];
    EXPECT_EQ(colour_of.try_emplace(instance, colour).first->second, colour);
    EXPECT_EQ(instance_of.try_emplace(colour, instance).first->second, instance);
  }
  EXPECT_GT(colour_of.size(), 20u);
}

// What does not name primitives is the picture of the flattened scene; ids tell the same triangles apart.
TEST_F(ShowInstances, OtherViewsAreThoseOfTheFlattenedScene) {
  const Scene scene = make_instances(60), flat = flattened(scene);
  for (const Show show : {Show::normals, Show::depth})
    EXPECT_EQ(seen_in_lockstep(scene, show).image, seen_in_lockstep(flat, show).image) << name_of(show);
  const SeenInstances levels = seen_in_lockstep(scene, Show::ids), one = seen_in_lockstep(flat, Show::ids);
  std::map<uint, uint> colours;
  for (std::size_t i = 0; i < one.image.size(); ++i)
    EXPECT_EQ(colours.try_emplace(one.image[i], levels.image[i]).first->second, levels.image[i]);
  const std::set<uint> others(levels.image.begin(), levels.image.end());
  EXPECT_EQ(others.size(), colours.size());
  EXPECT_GT(others.size(), 200u);
  const SeenInstances all_one = seen_in_lockstep(flat, Show::instances);
  EXPECT_EQ(std::set<uint>(all_one.image.begin(), all_one.image.end()).size(), 2u) << "and nothing";
}

TEST_F(ShowInstances, StepsOfRaysAddUpToWhatIsCounted) {
  const SeenInstances seen = seen_in_lockstep(make_instances(60), Show::steps);
  ASSERT_EQ(seen.steps.size(), seen_rays);
  EXPECT_EQ(std::accumulate(seen.steps.begin(), seen.steps.end(), std::uint64_t{0}), seen.counts.steps);
}

}  // namespace
}  // namespace coppice
