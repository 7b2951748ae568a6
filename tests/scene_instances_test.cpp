// Scenes with instances, on the host: flattened they are what the device makes of them, whatever comes first.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "render/scene_arrays.h"
#include "scene/bounds.h"
#include "scene/instances.h"
#include "scene/scene_source.h"
#include "support/instances.h"
#include "support/moving_meshes.h"
#include "support/triangles.h"

namespace coppice {
namespace {

Scene swarm_by_random_transforms(std::uint32_t count, float exponent) {
  Scene scene = make_instances(count);
  Random random(3);
  for (Instance& instance : scene.instances)
    instance.transform = columns_of(random_transform(random, exponent, 5));
  return scene;
}

bool same_corners(std::span<const Triangle> a, std::span<const Triangle> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(SceneInstances, FlattenedAsTheStageRoundsThem) {
  for (const float exponent : {1.0f, 20.0f, 60.0f}) {
    Scene scene = swarm_by_random_transforms(30, exponent);
    scene.instances[3].transform[1][2] = 1e-40f;
    scene.instances[4].transform[0] = {-0.0f, 0, 1e-44f};
    const SceneArrays arrays = scene_arrays(scene);
    InstancesToTrace same{{}, arrays.mesh_index, arrays.transforms};
    for (const InstancedMesh& mesh : arrays.meshes) {
      const auto first = arrays.triangles.begin() + mesh.first_triangle;
      same.meshes.emplace_back(first, first + mesh.triangle_count);
    }
    const Scene flat = flattened(scene);
    EXPECT_TRUE(same_corners(scene_arrays(flat).triangles, flattened(same))) << exponent;
    EXPECT_EQ(flat.material_index.size(), flat.indices.size());
    EXPECT_TRUE(flat.instances.empty() && flat.meshes.empty());
  }
}

TEST(SceneInstances, StandUpAndComeIntoRangeBeforeOrAfter) {
  for (const std::string_view up : UP_AXES) {
    for (const float scale : {0x1p-60f, 1.0f, 0x1p50f}) {
      Scene scene = swarm_by_random_transforms(12, 1);
      for (Instance& instance : scene.instances) instance.transform *= scale;
      Scene after = flattened(scene);
      for (Scene* const one : {&scene, &after}) {
        stand_up(*one, up);
        bring_into_range(*one);
      }
      EXPECT_EQ(std::abs(scene.scale_exponent - after.scale_exponent) <= 1, true);
      const int more = scene.scale_exponent - after.scale_exponent;  // boxes reach farther than triangles
      for (glm::vec3& position : after.positions) position *= std::ldexp(1.0f, more);
      EXPECT_TRUE(same_corners(triangles_of(flattened(scene)), triangles_of(after))) << up << scale;
    }
  }
}

// At second 0 keyframes have them where the scene has them, however it was turned and scaled; vertices of
// meshes stay in the space of the mesh.
TEST(SceneInstances, ThatMoveStandUpAndComeIntoRangeToo) {
  for (const std::string_view up : {"y", "-x", "z"}) {
    for (const double scale : {0x1p-60, 1.0, 0x1p50}) {
      InstanceComposition composition = meshes_that_move(2);
      for (const std::uint32_t root : {0u, 1u, 3u}) {
        composition.nodes.nodes[root].scale *= scale;
        composition.nodes.nodes[root].translation *= scale;
      }
      for (double& value : composition.nodes.tracks[0].keyframes.values) value *= scale;
      Scene scene = compose_instances(composition);
      const std::vector<glm::vec3> positions = scene.positions;
      stand_up(scene, up);
      bring_into_range(scene);
      const std::vector<glm::mat4x3> start = instances_at(*scene.motion, 0);
      const std::vector<std::uint32_t>& moved = scene.motion->moved_instances;
      ASSERT_EQ(moved, (std::vector<std::uint32_t>{1, 3}));
      for (std::size_t i = 0; i < moved.size(); ++i)
        EXPECT_EQ(start[i], scene.instances[moved[i]].transform) << up << scale;
      EXPECT_EQ(scene.positions, positions);
      EXPECT_EQ(standing_at(scene, 0).positions, positions);
    }
  }
}

// A camera that the scene does not give sees them at every time.
TEST(SceneInstances, CamerasSeeWhereTheyGo) {
  Scene scene = compose_instances(meshes_that_move(2));
  const Camera moving = frame_scene(scene, 1.5f), still = frame_scene(standing_at(scene, 0), 1.5f);
  EXPECT_NE(moving.target, still.target);
}

TEST(SceneInstances, AsManyAsWereAskedFor) {
  for (const std::uint32_t count : {1u, 2u, 3u, 4u, 100u}) {
    const std::string name = "instances:" + std::to_string(count);
    const Scene kept = open_scene(name, "y", true), flat = open_scene(name);
    EXPECT_EQ(kept.instances.size(), count);
    EXPECT_EQ(instanced_triangles(kept), flat.indices.size());
    EXPECT_EQ(swarm_triangles(count), flat.indices.size());
    EXPECT_EQ(built_in_size(name)->triangles, flat.indices.size());
    EXPECT_LE(flat.positions.size(), built_in_size(name)->vertices);
  }
}

TEST(SceneInstances, CamerasSeeAllOfThem) {
  Scene scene = swarm_by_random_transforms(50, 1);
  scene.camera.reset();
  const Bounds of_boxes = active_bounds(scene), of_triangles = active_bounds(flattened(scene));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(of_boxes.low[axis], of_triangles.low[axis]);
    EXPECT_GE(of_boxes.high[axis], of_triangles.high[axis]);
  }
  const Camera far = frame_scene(scene, 1.5f), near = frame_scene(flattened(scene), 1.5f);
  EXPECT_GE(glm::distance(far.position, far.target), glm::distance(near.position, near.target));
  EXPECT_LE(glm::distance(far.position, far.target), 2 * glm::distance(near.position, near.target));
}

}  // namespace
}  // namespace coppice
