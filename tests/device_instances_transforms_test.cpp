// Instances by every transform: the hits are those of the flattened scene bit for bit, none is lost and none
// invented.
#include <algorithm>
#include <cmath>

#include "analysis/hard_rays.h"
#include "scene/hard_cases.h"
#include "support/floor.h"
#include "support/rays.h"
#include "support/traced_instances.h"

namespace coppice {
namespace {

std::vector<Triangle> mesh_of(const char* name, std::uint32_t triangles) {
  return triangles_of(find_hard_case(name)->make(triangles, 1));
}

TEST_F(DeviceInstances, RandomTransforms) {
  for (const float exponent : {0.0f, 2.0f, 20.0f}) {
    const InstancesToTrace scene = soups(100, exponent, 1);
    const std::vector<Triangle> triangles = flattened(scene);
    expect_flat(scene, rays_around(triangles, 300, 5), "around, " + std::to_string(exponent));
    expect_flat(scene, rays_at_edges(triangles, 300, 6), "edges, " + std::to_string(exponent));
  }
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

}  // namespace
}  // namespace coppice
