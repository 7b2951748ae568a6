// Two levels: every stage in lockstep with its twin.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "render/frame.h"
#include "scene/instances.h"
#include "stages/errors.h"
#include "support/floor.h"
#include "support/rays.h"
#include "support/traced_instances.h"

namespace coppice {
namespace {

TEST_F(DeviceInstances, FewOrNoInstances) {
  const std::vector<Ray> rays = rays_around(random_soup(50, 1), 100, 7);
  InstancesToTrace scene = soups(0, 1, 2);
  const TracedInstances none = trace(scene, rays);
  EXPECT_EQ(none.state.active_count, 0u);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(none.hits[i].triangle, NO_TRIANGLE);
    EXPECT_EQ(none.hit_instances[i], NO_INSTANCE);
  }
  for (std::uint32_t instances = 1; instances <= 5; ++instances) {
    scene = soups(instances, 1, 3);
    expect_flat(scene, rays_around(flattened(scene), 200, 8), std::to_string(instances));
  }
  scene.meshes.assign(5, {});
  EXPECT_EQ(trace(scene, rays).state.active_count, 0u);
  scene.meshes.clear();  // every index is out of range
  EXPECT_EQ(trace(scene, rays).state.active_count, 0u);
}

// Of equally close ones the smaller instance, whatever the tree, then the smaller triangle.
TEST_F(DeviceInstances, Ties) {
  InstancesToTrace scene;
  scene.meshes = {{FLOOR, FLOOR}, {FLOOR, FLOOR, FLOOR}};
  Random random(8);
  for (uint i = 0; i < 40; ++i) {
    scene.mesh_index.push_back(random.below(2));
    scene.transforms.push_back(moved_by({0, 0, 0}));
  }
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i) rays.push_back(down_at(0.01f * static_cast<float>(i), 0.2f));
  const TracedInstances traced = trace(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(traced.hit_instances[i], 0u) << i;
    EXPECT_EQ(traced.hits[i].triangle, 0u) << i;
  }
}

TEST_F(DeviceInstances, TreesTooDeepForTheStackAreRefusedByName) {
  const InstancesToTrace scene = soups(50, 1, 19);
  const std::vector<Ray> rays = rays_around(flattened(scene), 64, 20);
  const TracedInstances expected = trace(scene, rays);
  TraceOptions options = test_trace_options(1, 1);
  options.stack_entries = expected.height;
  const TracedInstances just = trace(scene, rays, options);
  EXPECT_EQ(just.state.error_word, 0u);
  EXPECT_EQ(compare_hits(just.hits, expected.hits).count, 0u);
  --options.stack_entries;
  const TracedInstances refused = trace(scene, rays, options);
  EXPECT_EQ(refused.state.error_word, ERROR_TREE_TOO_DEEP);
  EXPECT_NE(describe_error_word(refused.state.error_word).find("trace_instances"), std::string::npos);
}

// Every builder, codes of both lengths, and one mesh that is built again while the others stay as they are.
TEST_F(DeviceInstances, EveryBuilderAndOnlyTheMeshesThatMoved) {
  InstancesToTrace scene = soups(70, 1, 22);
  const std::vector<Ray> rays = rays_around(flattened(scene), 300, 23);
  const std::vector<Hit> expected = trace(scene, rays).hits;
  for (const NamedDeviceBuilder& builder : device_builders()) {
    BuildOptions options;
    options.builder = builder.builder;
    options.morton_bits = 60;
    EXPECT_EQ(compare_hits(trace(scene, rays, test_trace_options(1, 1), options).hits, expected).count, 0u)
        << builder.name;
  }
  Layout layout(test_device().properties().max_block_bytes);
  const InstanceSlots slots = plan_for(layout, scene, rays.size());
  GpuExecutor gpu(test_device(), layout);
  upload_instances(gpu, slots, scene, rays);
  Chain first = gpu.chain();
  append_all_meshes(first, slots.plan);
  append_top(first, slots.plan);
  gpu.record(first.steps()).submit_and_wait(submit_limit_seconds);
  const std::vector<Node> before = gpu.read(slots.plan.mesh_nodes);
  scene.meshes[3] = random_soup(33, 99);
  upload_instances(gpu, slots, scene, rays);
  Chain second = gpu.chain();
  constexpr std::uint32_t moved[] = {3};
  append_meshes(second, slots.plan, moved);
  append_top(second, slots.plan);
  append_instance_hits(second, slots.plan, slots.rays, slots.hit_instances,
                       static_cast<std::uint32_t>(rays.size()), test_trace_options(1, 1));
  std::size_t builds = 0;
  for (const Step& step : second.steps()) builds += stage_of(step) == &stages::ploc_finish;
  EXPECT_EQ(builds, 2u);
  gpu.record(second.steps()).submit_and_wait(submit_limit_seconds);
  const auto hits = flattened_hits(scene, gpu.read(slots.rays.hits), gpu.read(slots.hit_instances));
  EXPECT_EQ(compare_hits(hits, trace(scene, rays).hits).count, 0u);
  const std::vector<Node> after = gpu.read(slots.plan.mesh_nodes);
  const std::uint32_t first_node = slots.plan.ranges[3].first_node;
  EXPECT_EQ(std::memcmp(before.data(), after.data(), first_node * sizeof(Node)), 0);
  EXPECT_NE(std::memcmp(&before[first_node], &after[first_node], 65 * sizeof(Node)), 0);
}

// Hits that are there already are kept where nothing is closer.
TEST_F(DeviceInstances, ImprovesTheHitsThatItIsGiven) {
  const InstancesToTrace scene = soups(40, 1, 24);
  const std::vector<Ray> rays = rays_around(flattened(scene), 300, 25);
  Layout layout(test_device().properties().max_block_bytes);
  const InstanceSlots slots = plan_for(layout, scene, rays.size());
  LockstepExecutor executor(test_device(), layout);
  upload_instances(executor, slots, scene, rays);
  ASSERT_FALSE(executor.run([&](Chain& chain) { append_all(chain, slots, test_trace_options(1, 1)); }));
  const std::vector<Hit> hits = executor.gpu().read(slots.rays.hits);
  const std::vector<uint> instances = executor.gpu().read(slots.hit_instances);
  const auto again = [&](float factor, uint instance) {
    std::vector<Hit> given = hits;
    for (Hit& hit : given) hit = hit.triangle == NO_TRIANGLE ? hit : Hit{hit.t * factor, 7, 0.5f, 0.5f};
    executor.upload(slots.rays.hits, std::span<const Hit>(given));
    executor.upload(slots.hit_instances, std::span<const uint>(std::vector<uint>(rays.size(), instance)));
    EXPECT_FALSE(executor.run([&](Chain& chain) {
      append_instance_hits(chain, slots.plan, slots.rays, slots.hit_instances,
                           static_cast<std::uint32_t>(rays.size()), test_trace_options(1, 1));
    }));
    return executor.gpu().read(slots.hit_instances);
  };
  EXPECT_EQ(again(2, 1000), instances);
  EXPECT_EQ(compare_hits(executor.gpu().read(slots.rays.hits), hits).count, 0u);
  const std::vector<uint> kept = again(0.5f, 1000);
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(kept[i], hits[i].triangle == NO_TRIANGLE ? NO_INSTANCE : 1000u);
  again(1, 1000);  // a tie goes to the smaller instance
  EXPECT_EQ(compare_hits(executor.gpu().read(slots.rays.hits), hits).count, 0u);
}

// A swarm rests at turn 0, bit for bit, and keeps its shapes, sizes, heights and distances from the axis.
TEST_F(DeviceInstances, SwarmsMove) {
  constexpr std::uint32_t count = 1000;
  Layout layout(test_device().properties().max_block_bytes);
  const InstancePlan plan = plan_instances(layout, {}, count, {});
  const SwarmSlots swarm{layout.add<InstanceTransform>("rest", count), layout.add<uint>("turn", 1)};
  std::vector<InstanceTransform> rest = scene_arrays(make_instances(count)).transforms;
  for (InstanceTransform& t : rest)
    for (vec3* const row : {&t.row_x, &t.row_y, &t.row_z}) *row += vec3(0);  // +0 for -0
  LockstepExecutor executor(test_device(), layout);
  const auto at = [&](std::span<const InstanceTransform> from, std::uint32_t seed, uint turn) {
    executor.upload(swarm.rest, from);
    executor.upload(swarm.turn, std::span<const uint>(&turn, 1));
    const auto difference = executor.run([&](Chain& chain) { append_moves(chain, plan, swarm, seed); });
    EXPECT_FALSE(difference) << difference->slot << difference->index << "\ncpu " << difference->cpu
                             << "\ngpu " << difference->gpu;
    return executor.gpu().read(plan.transforms);
  };
  const auto same = [](const std::vector<InstanceTransform>& a, const std::vector<InstanceTransform>& b) {
    return std::memcmp(a.data(), b.data(), count * sizeof(InstanceTransform)) == 0;
  };
  EXPECT_TRUE(same(at(rest, 1, 0), rest));
  EXPECT_FALSE(same(at(rest, 1, 1u << 28), at(rest, 2, 1u << 28)));
  for (const std::uint32_t turn : {1u << 20, 0x12345678u, 0x80000000u, 0xffffffffu}) {
    const std::vector<InstanceTransform> moved = at(rest, 1, turn);
    for (std::uint32_t i = 0; i < count; ++i) {
      const InstanceTransform &a = rest[i], &b = moved[i];
      const auto determinant = [](const InstanceTransform& t) {
        return glm::dot(t.row_x, glm::cross(t.row_y, t.row_z));
      };
      ASSERT_NEAR(std::hypot(a.move_x, a.move_z), std::hypot(b.move_x, b.move_z), 1e-4f) << i;
      ASSERT_EQ(a.move_y, b.move_y) << i;
      ASSERT_NEAR(determinant(a), determinant(b), 1e-5f) << i;
      ASSERT_NEAR(glm::length(a.row_y), glm::length(b.row_y), 1e-5f) << i;
    }
    EXPECT_FALSE(same(moved, rest)) << turn;
  }
  // Of any size, denormal ones and -0 too; what overflows is an inactive instance.
  std::vector<InstanceTransform> any;
  Random random(5);
  for (std::uint32_t i = 0; i < count; ++i)
    any.push_back(random_transform(random, i % 2 == 0 ? 127.9f : 20.0f, std::ldexp(1.0f, 120 - i % 250)));
  any[1].row_x = {-0.0f, 1e-42f, -1e-44f};
  for (const std::uint32_t turn : {0u, 0x12345678u, 0xc0000001u}) at(any, 3, turn);
}

TEST_F(DeviceInstances, LoopsThatADriverEndsAreNamed) {
  const InstancesToTrace scene = soups(30, 1, 26);
  const std::vector<Ray> rays = rays_at_edges(flattened(scene), 64, 27);
  Layout layout(test_device().properties().max_block_bytes);
  const InstanceSlots slots = plan_for(layout, scene, rays.size());
  GpuExecutor gpu(test_device(), layout);
  upload_instances(gpu, slots, scene, rays);
  TraceOptions options = test_trace_options(1, 1);
  options.max_turns = 5;
  Chain chain = gpu.chain();
  append_all(chain, slots, options);
  gpu.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  const std::uint32_t error_word = gpu.read(slots.plan.top.state)[0].error_word;
  EXPECT_EQ(error_word, ERROR_TRACE_STEPS);
  EXPECT_NE(describe_error_word(error_word).find("trace_instances"), std::string::npos);
}

TEST_F(DeviceInstances, OptionsThatItDoesNotHaveAreNamed) {
  const InstancesToTrace scene = soups(3, 1, 21);
  Layout layout;
  const InstanceSlots slots = plan_for(layout, scene, 1);
  const std::vector<std::uint64_t> addresses(layout.block_bytes().size());
  Chain chain(addresses);
  TraceOptions options;
  options.triangle_test = TRIANGLE_FAST;
  EXPECT_THROW(append_all(chain, slots, options), std::invalid_argument);
}

// The picture of a scene with instances and of the flattened one, in bands and with several samples a pixel.
TEST_F(DeviceInstances, ThePictureIsThatOfTheFlattenedScene) {
  const auto picture = [](const Scene& scene) {
    const SceneArrays arrays = scene_arrays(scene);
    FrameOptions options{.build = BuildOptions{}, .trace = test_trace_options(150, 90)};
    options.trace.samples = 2;
    Layout layout(test_device().properties().max_block_bytes);
    const FramePlan plan = plan_frame(layout, arrays, options);
    EXPECT_EQ(plan.levels.has_value(), !scene.instances.empty());
    GpuExecutor gpu(test_device(), layout);
    upload_frame(gpu, plan, arrays, make_film(scene, {}, 150, 90, 2));
    Chain chain = gpu.chain();
    append_frame_build(chain, plan);
    TracePieces pieces = plan.pieces(plan.trace);
    while (!pieces.done()) pieces.append(chain, 2000);
    gpu.record(chain.steps()).submit_and_wait(submit_limit_seconds);
    EXPECT_EQ(gpu.read(plan.tree.state)[0].error_word, 0u);
    return gpu.read(plan.trace.image);
  };
  const Scene scene = make_instances(100);
  const std::vector<uint> image = picture(scene);
  EXPECT_EQ(image, picture(flattened(scene)));
  EXPECT_GT(std::ranges::count_if(image, [&](uint pixel) { return pixel != image[0]; }), 1000);
}

TEST_F(DeviceInstances, FramesThatOnlyOneLevelHasAreNamed) {
  const SceneArrays arrays = scene_arrays(make_instances(3));
  Layout layout;
  FrameOptions options{.build = BuildOptions{}, .trace = {}};
  options.trace.walk = Walk::wide_single;
  EXPECT_THROW(plan_frame(layout, arrays, options), std::invalid_argument);
  options = {.build = {}, .node_count = 5, .trace = {}};
  EXPECT_THROW(plan_frame(layout, arrays, options), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
