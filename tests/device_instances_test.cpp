// Two levels: every stage in lockstep with its twin, and the hits those of the flattened scene, bit for bit,
// whatever the transforms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "analysis/compare.h"
#include "analysis/hard_rays.h"
#include "analysis/judge_hits.h"
#include "builders/ploc.h"
#include "scene/hard_cases.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"
#include "support/device_run.h"
#include "support/floor.h"
#include "support/instances.h"
#include "support/rays.h"
#include "support/triangles.h"

namespace coppice {
namespace {

struct TracedInstances {
  std::vector<Hit> hits;  // with triangles of the flattened scene
  std::vector<uint> hit_instances;
  std::vector<Aabb> boxes;
  std::vector<PlacedInstance> placed;
  BuildState state;
  std::uint32_t height;  // of both levels
};

class DeviceInstances : public DeviceTest {
 protected:
  static TracedInstances trace(const InstancesToTrace& scene, std::span<const Ray> rays,
                               const TraceOptions& options = test_trace_options(1, 1),
                               const BuildOptions& build = {}) {
    Layout layout(test_device().properties().max_block_bytes);
    const InstanceSlots slots = plan_for(layout, scene, rays.size(), build);
    LockstepExecutor executor(test_device(), layout);
    upload_instances(executor, slots, scene, rays);
    const auto difference = executor.run([&](Chain& chain) { append_all(chain, slots, options); });
    EXPECT_FALSE(difference) << difference->stage << ", " << difference->slot << "[" << difference->index
                             << "]\ncpu " << difference->cpu << "\ngpu " << difference->gpu;
    const GpuExecutor& gpu = executor.gpu();
    TracedInstances traced{gpu.read(slots.rays.hits),           gpu.read(slots.hit_instances),
                           gpu.read(slots.plan.instance_boxes), gpu.read(slots.plan.placed),
                           gpu.read(slots.plan.top.state)[0],   gpu.read(slots.plan.mesh_height)[0]};
    if (traced.state.active_count > 0)
      traced.height += gpu.read(Slot<Node>{slots.plan.top.nodes.place, 1})[0].height;
    traced.hits = flattened_hits(scene, traced.hits, traced.hit_instances);
    return traced;
  }

  static void expect_no_miss(std::span<const Node> nodes, std::span<const Triangle> triangles,
                             std::span<const Ray> rays, std::span<const Hit> hits, const std::string& what) {
    const HitVerdicts verdicts = judge_hits(nodes, triangles, rays, hits);
    EXPECT_EQ(verdicts.false_hits, 0u) << what;
    EXPECT_EQ(verdicts.missed, 0u) << what;
  }

  // By brute force over the flattened scene, which no box can lose a hit of. Rays are not from far away.
  static void expect_flat(const InstancesToTrace& scene, std::span<const Ray> rays, const std::string& what) {
    const TracedInstances traced = trace(scene, rays);
    EXPECT_EQ(traced.state.error_word, 0u) << what;
    const std::vector<Triangle> triangles = flattened(scene);
    TraceOptions options = test_trace_options(1, 1);
    options.walk = Walk::brute_force;
    const TracedRays flat = trace_on_device({}, triangles, rays, options);
    const HitDifference difference = compare_hits(traced.hits, flat.hits);
    EXPECT_EQ(difference.count, 0u) << what << ": other triangles " << difference.other_triangle;
    expect_no_miss(build_ploc(triangles, {16, 30}).nodes, triangles, rays, traced.hits, what);
  }
};

std::vector<Triangle> mesh_of(const char* name, std::uint32_t triangles) {
  return triangles_of(find_hard_case(name)->make(triangles, 1));
}

// Meshes of all small sizes.
InstancesToTrace soups(std::uint32_t instances, float exponent, std::uint64_t seed) {
  InstancesToTrace scene;
  scene.meshes = {random_soup(200, 1), random_soup(1, 2), {}, random_soup(33, 3), random_soup(2, 4)};
  Random random(seed);
  for (uint i = 0; i < instances; ++i) {
    scene.mesh_index.push_back(i % 5);
    scene.transforms.push_back(random_transform(random, exponent, 3));
  }
  return scene;
}

TEST_F(DeviceInstances, RandomTransforms) {
  for (const float exponent : {0.0f, 2.0f, 20.0f}) {
    const InstancesToTrace scene = soups(100, exponent, 1);
    const std::vector<Triangle> triangles = flattened(scene);
    expect_flat(scene, rays_around(triangles, 300, 5), "around, " + std::to_string(exponent));
    expect_flat(scene, rays_at_edges(triangles, 300, 6), "edges, " + std::to_string(exponent));
  }
}

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

// Flat, on a line, at a point; each of them several times over a mesh whose hits count where they are flat.
TEST_F(DeviceInstances, TransformsWithoutAnInverse) {
  Random random(4);
  InstancesToTrace scene;
  scene.meshes = {random_soup(60, 5), mesh_of("sphere", 100)};
  for (uint i = 0; i < 60; ++i) {
    scene.mesh_index.push_back(i % 2);
    const vec3 a = random.in_cube(), b = random.in_cube(), move = 2.0f * random.in_cube();
    const float s = random.uniform(-2, 2), t = random.uniform(-2, 2);
    const vec3 c = i % 5 == 0 ? a : i % 5 == 1 ? vec3(0) : i % 5 == 2 ? s * a + t * b : random.in_cube();
    scene.transforms.push_back(i % 6 == 0   ? transform_of(a, s * a, t * a, move)
                               : i % 6 == 1 ? transform_of(vec3(0), vec3(0), vec3(0), move)
                                            : transform_of(a, b, c, move));
  }
  const std::vector<Triangle> triangles = flattened(scene);
  expect_flat(scene, rays_around(triangles, 400, 9), "around");
  expect_flat(scene, rays_at_edges(triangles, 400, 10), "edges");
  const TracedInstances traced = trace(scene, rays_at_edges(triangles, 400, 10));
  EXPECT_TRUE(std::isinf(traced.placed[1].pad.x) && std::isinf(traced.placed[7].pad.z));
  EXPECT_TRUE(std::ranges::any_of(traced.hit_instances,
                                  [&](uint i) { return i != NO_INSTANCE && i % 6 > 1 && i % 5 < 2; }));
}

TEST_F(DeviceInstances, NotFiniteEntriesAreInactiveAndOthersAreNot) {
  InstancesToTrace scene;
  scene.meshes = {random_soup(40, 6)};
  scene.mesh_index = {0};
  scene.transforms = {moved_by({0, 0, 0})};
  const auto entry = [](InstanceTransform& transform, std::size_t k) -> float& {
    return reinterpret_cast<float*>(&transform)[k];
  };
  for (std::size_t k = 0; k < 12; ++k) {
    for (const float bad : {NOT_A_NUMBER, INFINITE, -INFINITE}) {
      scene.mesh_index.push_back(0);
      scene.transforms.push_back(moved_by({0, 0, 0}));
      entry(scene.transforms.back(), k) = bad;
    }
  }
  const std::vector<Ray> rays = rays_at_edges(scene.meshes[0], 200, 11);
  const TracedInstances traced = trace(scene, rays);
  EXPECT_EQ(traced.state.active_count, 1u);
  EXPECT_GT(std::ranges::count(traced.hit_instances, 0u), 100);
  const std::vector<Triangle> flat = flattened(scene);
  for (const Triangle& triangle : std::span(flat).subspan(40)) EXPECT_TRUE(std::isnan(triangle.a.x));
}

// Corners that are not finite once transformed belong to triangles that are inactive; the others are hit.
TEST_F(DeviceInstances, OverflowAndTheEndsOfTheRange) {
  InstancesToTrace scene;
  scene.meshes = {{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)},
                   {vec3(0), vec3(8, 0, 0), vec3(0, 8, 0)},
                   {vec3(0, 0, 1), vec3(-8, 0, 1), vec3(0, -1, 1)}}};
  const float most = 0x1p126f;
  for (const vec3 move : {vec3(0), vec3(most, 0, 0), vec3(-most, most, 0)}) {
    scene.mesh_index.push_back(0);
    scene.transforms.push_back(transform_of({most, 0, 0}, {0, most, 0}, {0, 0, most}, move));
  }
  std::vector<Ray> rays;
  for (const vec3 to :
       {vec3(0.25f, 0.25f, 0), vec3(-0.5f, -0.2f, 1), vec3(1.25f, 0.25f, 0), vec3(-0.75f, 1.25f, 0)})
    rays.push_back({most * to + vec3(0, 0, 0x1p100f), 0, vec3(0, 0, -1), INFINITE});
  const TracedInstances traced = trace(scene, rays);
  EXPECT_EQ(traced.state.active_count, 3u);
  const TracedRays flat = [&] {
    TraceOptions options = test_trace_options(1, 1);
    options.walk = Walk::brute_force;
    return trace_on_device({}, flattened(scene), rays, options);
  }();
  EXPECT_EQ(compare_hits(traced.hits, flat.hits).count, 0u);
  EXPECT_GT(flat.hit_count, 0u);
  for (const float scale : {0x1p-125f, 0x1p-100f, 0x1p-60f, 0x1p-30f, 0x1p30f, 0x1p60f, 0x1p90f}) {
    scene = soups(20, 0, 13);
    // What the transform makes large the mesh makes small.
    for (auto& mesh : scene.meshes) {
      for (Triangle& triangle : mesh)
        for (vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) *corner *= 1 / scale;
    }
    for (InstanceTransform& transform : scene.transforms) {
      for (vec3* row : {&transform.row_x, &transform.row_y, &transform.row_z}) *row *= scale;
    }
    expect_flat(scene, rays_at_edges(flattened(scene), 200, 14), std::to_string(std::log2(scale)));
  }
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

// Every ray from the inside of a closed mesh hits, whatever becomes of the mesh.
TEST_F(DeviceInstances, ClosedMeshesDoNotLeak) {
  Random random(9);
  for (const char* name : {"sphere", "room"}) {
    InstancesToTrace scene;
    scene.meshes = {mesh_of(name, 300)};
    scene.mesh_index = {0};
    for (int i = 0; i < 6; ++i) {
      scene.transforms = {
          random_transform(random, 1.0f + 3.0f * static_cast<float>(i), i % 2 ? 100.0f : 1.0f)};
      const std::vector<Triangle> triangles = flattened(scene);
      vec3 own_low = scene.meshes[0][0].a, own_high = own_low;
      for (const Triangle& triangle : scene.meshes[0]) {
        for (const vec3& corner : {triangle.a, triangle.b, triangle.c})
          own_low = glm::min(own_low, corner), own_high = glm::max(own_high, corner);
      }
      const vec3 inside = 0.5f * (own_low + own_high);
      const InstanceTransform& by = scene.transforms[0];
      const vec3 from(glm::dot(by.row_x, inside) + by.move_x, glm::dot(by.row_y, inside) + by.move_y,
                      glm::dot(by.row_z, inside) + by.move_z);
      const std::vector<Ray> rays = inside_rays(from, triangles, 500, 10);
      const TracedInstances traced = trace(scene, rays);
      const HitVerdicts verdicts =
          judge_hits(build_ploc(triangles, {16, 30}).nodes, triangles, rays, traced.hits);
      EXPECT_EQ(verdicts.missed + verdicts.missed_at_edges, 0u) << name << i;
      EXPECT_EQ(verdicts.false_hits, 0u) << name << i;
    }
  }
}

// Rays that are hard on boxes and triangles, from far away too: no hit is lost and none invented.
TEST_F(DeviceInstances, HardRays) {
  for (const float exponent : {0.0f, 6.0f}) {
    const InstancesToTrace scene = soups(60, exponent, 16);
    const std::vector<Triangle> triangles = flattened(scene);
    const Bvh bvh = build_ploc(triangles, {16, 30});
    for (const RayKindName& kind : ray_kinds()) {
      const std::vector<Ray> rays = hard_rays(kind.kind, triangles, bvh.nodes, 200, 17);
      expect_no_miss(bvh.nodes, triangles, rays, trace(scene, rays).hits, std::string(kind.name));
    }
  }
}

// Boxes hold every corner as it is rounded, without any room.
TEST_F(DeviceInstances, BoxesHoldEveryCorner) {
  const InstancesToTrace scene = soups(300, 30, 18);
  const TracedInstances traced = trace(scene, std::vector<Ray>{down_at(0, 0)});
  for (std::size_t i = 0; i < scene.mesh_index.size(); ++i) {
    InstancesToTrace one{scene.meshes, {scene.mesh_index[i]}, {scene.transforms[i]}};
    for (const Triangle& triangle : flattened(one)) {
      for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_GE(corner[axis], traced.boxes[i].box_min[axis]);
          EXPECT_LE(corner[axis], traced.boxes[i].box_max[axis]);
        }
      }
    }
  }
}

// The same mesh moved, not turned: its boxes are as tight as they are.
TEST_F(DeviceInstances, BoxesOfMovedMeshesAreTight) {
  InstancesToTrace scene;
  scene.meshes = {{FLOOR}};
  scene.mesh_index = {0};
  scene.transforms = {moved_by({2, 3, -4})};
  const Aabb box = trace(scene, std::vector<Ray>{down_at(0, 0)}).boxes[0];
  EXPECT_EQ(box.box_min, vec3(2, 3, -4));
  EXPECT_EQ(box.box_max, vec3(3, 4, -4));
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

// A swarm is back where it began after a whole cycle, moves in between, and keeps to its radius and sizes.
TEST_F(DeviceInstances, SwarmsMove) {
  constexpr std::uint32_t count = 1000;
  Layout layout(test_device().properties().max_block_bytes);
  const InstancePlan plan = plan_instances(layout, {}, count, {});
  LockstepExecutor executor(test_device(), layout);
  const auto at = [&](std::uint32_t seed, std::uint32_t turn) {
    const auto difference = executor.run([&](Chain& chain) { append_moves(chain, plan, seed, turn, 3); });
    EXPECT_FALSE(difference) << difference->slot << difference->index << "\ncpu " << difference->cpu
                             << "\ngpu " << difference->gpu;
    return executor.gpu().read(plan.transforms);
  };
  const auto same = [](const std::vector<InstanceTransform>& a, const std::vector<InstanceTransform>& b) {
    return std::memcmp(a.data(), b.data(), count * sizeof(InstanceTransform)) == 0;
  };
  const std::vector<InstanceTransform> start = at(1, 0);
  EXPECT_TRUE(same(at(1, 0), start));
  EXPECT_FALSE(same(at(2, 0), start));
  std::uint32_t mirrored = 0;
  for (const std::uint32_t turn : {0u, 1u << 20, 0x12345678u, 0x80000000u, 0xffffffffu}) {
    const std::vector<InstanceTransform> moved = at(1, turn);
    EXPECT_EQ(same(moved, start), turn == 0);
    for (const InstanceTransform& t : moved) {
      EXPECT_LE(std::hypot(t.move_x, t.move_z), 8.0001f);
      const float determinant = glm::dot(t.row_x, glm::cross(t.row_y, t.row_z));
      const float size = std::cbrt(std::fabs(determinant));
      EXPECT_NEAR(glm::length(t.row_x), size, 1e-5f);
      EXPECT_NEAR(glm::dot(t.row_x, t.row_z), 0, 1e-5f);
      EXPECT_TRUE(size > 0.2499f && size < 1.0001f);
      mirrored += determinant < 0;
    }
  }
  EXPECT_EQ(mirrored, 5 * count / 2);
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
  EXPECT_THROW(append_moves(chain, slots.plan, 1, 0, 128), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
