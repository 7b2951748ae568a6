// Instances of meshes that deform, moved by keyframes: a frame is the picture of the flattened scene with all
// of it where the device has it, and what stands still keeps its tree.
#include <cmath>

#include "analysis/tree_hash.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/moving_frames.h"
#include "support/moving_meshes.h"

namespace coppice {
namespace {

using MovingMeshes = DeviceTest;

std::vector<uint> flattened_picture(const Scene& moved, const Film& film, const TraceOptions& trace) {
  return still_picture(flattened(moved), film, BuildOptions{}, trace);
}

TEST_F(MovingMeshes, AreThePicturesOfTheFlattenedScene) {
  const Scene scene = scene_of_moving_meshes(20);
  for (const DeviceBuilder builder : {DeviceBuilder::ploc, DeviceBuilder::hploc}) {
    const MovingOptions options = moving_options(Walk::binary, builder);
    const Film film = film_of(scene, options);
    MovingFrames frames(test_device(), scene, options);
    std::uint64_t last = 0;
    for (const double seconds : {0.0, 0.4, 1.7, 7.25}) {
      frames.submit(seconds, film);
      const MovingFrame frame = frames.take();
      EXPECT_TRUE(frame.rebuilt);
      EXPECT_EQ(frame.submits, 1u);
      const std::vector<uint> image(frame.image.begin(), frame.image.end());
      EXPECT_EQ(image, flattened_picture(as_moved(scene, frames), film, options.trace)) << seconds;
      EXPECT_NE(image_hash(image), last) << seconds;
      EXPECT_GT(frame.counts.hits, 200u);
      last = image_hash(image);
    }
  }
}

// The host knows the same places, but for the rounding of vertices.
TEST_F(MovingMeshes, AreWhereTheHostHasThem) {
  const Scene scene = scene_of_moving_meshes(5);
  const MovingOptions options = moving_options();
  MovingFrames frames(test_device(), scene, options);
  for (const double seconds : {0.0, 0.6, 30.0}) {
    frame_at(frames, seconds, film_of(scene, options));
    const Scene device = as_moved(scene, frames), host = standing_at(scene, seconds);
    for (std::size_t i = 0; i < host.instances.size(); ++i)
      EXPECT_EQ(device.instances[i].transform, host.instances[i].transform) << i << " at " << seconds;
    for (std::size_t v = 0; v < host.positions.size(); ++v)
      ASSERT_LT(glm::length(device.positions[v] - host.positions[v]), 1e-4 * (1 + seconds)) << v;
  }
}

// Whatever the trees are the picture is the same.
TEST_F(MovingMeshes, AreTheSamePicturesByRefits) {
  const Scene scene = scene_of_moving_meshes(12);
  for (const DeviceBuilder builder : {DeviceBuilder::ploc, DeviceBuilder::hploc}) {
    MovingOptions options = moving_options(Walk::binary, builder);
    MovingFrames built(test_device(), scene, options);
    options.tree_cost = true;
    const Film film = film_of(scene, options);
    for (const Update update : {Update::refit, Update::automatic}) {
      options.update = update;
      MovingFrames refitted(test_device(), scene, options);
      for (int frame = 0; frame < 4; ++frame) {
        refitted.submit(0.3 * frame, film);
        const MovingFrame left = refitted.take();
        EXPECT_EQ(left.submits, 1u);
        EXPECT_GT(left.sah, 1);
        if (update == Update::refit) {
          EXPECT_EQ(left.rebuilt, frame == 0);
        }
        EXPECT_EQ(image_hash(left.image), image_hash(frame_at(built, 0.3 * frame, film))) << frame;
      }
    }
  }
}

TEST_F(MovingMeshes, ASwarmMayBeRefittedToo) {
  const Scene scene = make_instances(200);
  MovingOptions options = moving_options();
  const Film film = film_of(scene, options);
  MovingFrames built(test_device(), scene, options);
  options.update = Update::refit;
  MovingFrames refitted(test_device(), scene, options);
  for (const double seconds : {0.0, 0.5, 3.0}) {
    refitted.submit(seconds, film);
    const MovingFrame frame = refitted.take();
    EXPECT_EQ(frame.rebuilt, seconds == 0);
    EXPECT_EQ(image_hash(frame.image), image_hash(frame_at(built, seconds, film))) << seconds;
  }
}

// A frame builds the trees of the two meshes that deform, and the one over the instances.
TEST_F(MovingMeshes, LeaveTheTreesOfOthersAsTheyAre) {
  const Scene scene = scene_of_moving_meshes(10);
  const MovingOptions options = moving_options();
  MovingFrames frames(test_device(), scene, options);
  std::size_t builds = 0;
  for (const Step& step : frames.steps()) builds += stage_of(step) == &stages::hploc_build;
  EXPECT_EQ(builds, 3u);
  const InstancePlan& plan = frames.plan().levels->plan;
  const auto trees = [&] {
    std::vector<std::uint64_t> hashes;
    for (std::uint32_t mesh = 0; mesh < 3; ++mesh)
      hashes.push_back(tree_hash(frames.executor().read(mesh_plan(plan, mesh).nodes)));
    return hashes;
  };
  const Film film = film_of(scene, options);
  frame_at(frames, 0.2, film);
  const std::vector<std::uint64_t> before = trees();
  frame_at(frames, 1.1, film);
  const std::vector<std::uint64_t> after = trees();
  EXPECT_EQ(before[0], after[0]);
  EXPECT_NE(before[1], after[1]);
  EXPECT_NE(before[2], after[2]);
}

TEST_F(MovingMeshes, OnlyTheTreeOverInstancesIsBuiltWhereOnlyTheyMove) {
  InstanceComposition composition = meshes_that_move(4);
  for (Scene& mesh : composition.meshes) mesh.motion = nullptr;
  Scene scene = compose_instances(composition);
  scene.camera = Camera{.position = {4, 6, 30}};
  const MovingOptions options = moving_options();
  MovingFrames frames(test_device(), scene, options);
  std::size_t builds = 0;
  for (const Step& step : frames.steps()) builds += stage_of(step) == &stages::hploc_build;
  EXPECT_EQ(builds, 1u);
  const Film film = film_of(scene, options);
  const std::vector<uint> image = frame_at(frames, 0.9, film);
  EXPECT_EQ(image, flattened_picture(as_moved(scene, frames), film, options.trace));
}

TEST_F(MovingMeshes, AreInLockstepWithTheTwins) {
  const Scene scene = scene_of_moving_meshes(3);
  const SceneArrays arrays = scene_arrays(scene);
  const MovingOptions options = moving_options(Walk::binary, DeviceBuilder::ploc);
  Layout layout(test_device().properties().max_block_bytes);
  FramePlan plan = plan_frame(layout, arrays, {.build = options.build, .trace = options.trace});
  InstancePlan& instances = plan.levels->plan;
  const MovingInstances moving =
      plan_moving_instances(layout, scene, instances, true, options.trace.max_turns);
  const InstancesTold told = plan_instances_told(layout, scene, moving);
  const InstancesLeft left = plan_instances_left(layout, instances, moving);
  LockstepExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, film_of(scene, options));
  upload_moving_instances(executor, moving, scene, arrays);
  const auto expect_none = [&](const auto& append) {
    const auto difference = executor.run(append);
    ASSERT_FALSE(difference) << difference->stage << ", " << difference->slot << " " << difference->index
                             << ": " << difference->cpu << " and " << difference->gpu;
  };
  expect_none([&](Chain& chain) { append_meshes(chain, instances, meshes_that_stand_still(scene)); });
  for (const double seconds : {0.0, 0.7}) {
    tell_instances(executor, told, scene, moving, seconds);
    expect_none([&](Chain& chain) {
      append_instance_places(chain, scene, instances, moving, told);
      append_instance_trees(chain, instances, moving, seconds == 0);
      TracePieces pieces = plan.pieces(plan.trace);
      while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
      append_instances_left(chain, instances, moving, left);
    });
  }
}

TEST_F(MovingMeshes, AreTheSameBitsInAnyOrderAndWithAnyNumberUnderWay) {
  const Scene scene = scene_of_moving_meshes(6);
  const auto hashes = [&](std::uint32_t under_way, bool reversed) {
    MovingOptions options = moving_options();
    options.under_way = under_way;
    MovingFrames frames(test_device(), scene, options);
    const Film film = film_of(scene, options);
    std::vector<std::uint64_t> result(6);
    std::deque<std::size_t> numbers;
    const auto take = [&] {
      result[numbers.front()] = image_hash(frames.take().image);
      numbers.pop_front();
    };
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (!frames.has_room()) take();
      numbers.push_back(reversed ? result.size() - 1 - i : i);
      frames.submit(0.25 * static_cast<double>(numbers.back()), film);
    }
    while (!frames.is_empty()) take();
    return result;
  };
  EXPECT_EQ(hashes(1, false), hashes(3, true));
}

// A mesh whose triangles vanish one by one, all of them in the end, and come back: its instances are inactive
// then. A refitted tree keeps leaves for what has vanished, and is built where something appears.
TEST_F(MovingMeshes, MayVanishAndComeBack) {
  InstanceComposition composition = meshes_that_move(1);
  Scene& mesh = composition.meshes[1];
  Motion motion;
  motion.rest = mesh.positions;
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  VertexSequence sequence{.vertices = {0, vertices}, .frames_per_second = 1};
  for (const std::uint32_t gone : {1u, 4u, vertices / 3, 0u, 1u}) {
    for (std::uint32_t v = 0; v < vertices; ++v)
      sequence.positions.push_back(v / 3 < gone ? glm::vec3{std::nanf("")} : mesh.positions[v]);
  }
  motion.sequences = {sequence};
  mesh.motion = std::make_shared<Motion>(motion);
  composition.nodes.nodes[4].scale = {1, 0, 1};  // of no inverse: its boxes are as good as infinite
  Scene scene = compose_instances(composition);
  scene.camera = Camera{.position = {4, 6, 30}};
  for (const Update update : {Update::rebuild, Update::refit}) {
    MovingOptions options = moving_options();
    options.update = update;
    const Film film = film_of(scene, options);
    MovingFrames frames(test_device(), scene, options);
    std::vector<std::uint32_t> active, submits;
    for (int second = 0; second < 5; ++second) {
      frames.submit(second, film);
      const MovingFrame frame = frames.take();
      active.push_back(frame.state.active_count);
      submits.push_back(frame.submits);
      const std::vector<uint> image(frame.image.begin(), frame.image.end());
      EXPECT_EQ(image, flattened_picture(as_moved(scene, frames), film, options.trace)) << second;
    }
    if (update == Update::rebuild) {
      EXPECT_EQ(active, (std::vector<std::uint32_t>{7, 7, 4, 7, 7}));
    } else {
      EXPECT_EQ(submits, (std::vector<std::uint32_t>{1, 1, 1, 2, 1}));
    }
  }
}

TEST_F(MovingMeshes, LikeAGpuGoThroughMappedMemory) {
  expect_same_like_a_gpu(scene_of_moving_meshes(4), moving_options(), 1.5);
}

}  // namespace
}  // namespace coppice
