// Instances that move: a frame is the picture of the flattened scene with every instance where the device has
// moved it, whatever came before it.
#include <algorithm>
#include <numeric>

#include "analysis/tree_hash.h"
#include "scene/instances.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/moving_frames.h"

namespace coppice {
namespace {

using MovingSwarm = DeviceTest;

TEST_F(MovingSwarm, AreThePicturesOfTheFlattenedScene) {
  const Scene scene = make_instances(500);
  for (const DeviceBuilder builder : {DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh}) {
    const MovingOptions options = moving_options(Walk::binary, builder);
    const Film film = film_of(scene, options);
    MovingFrames frames(test_device(), scene, options);
    std::vector<std::uint64_t> hashes;
    for (const double seconds : {0.0, 0.4, 3.0, 31.9, 1000.25}) {
      const std::vector<uint> image = frame_at(frames, seconds, film);
      const Scene moved = as_moved(scene, frames);
      EXPECT_EQ(image, still_picture(flattened(moved), film, BuildOptions{}, options.trace)) << seconds;
      if (seconds == 0) {
        EXPECT_EQ(image, still_picture(flattened(scene), film, BuildOptions{}, options.trace));
      }
      EXPECT_EQ(std::ranges::count(hashes, image_hash(image)), 0) << seconds;
      hashes.push_back(image_hash(image));
    }
  }
}

TEST_F(MovingSwarm, AreInLockstepWithTheTwins) {
  const Scene scene = make_instances(100);
  const SceneArrays arrays = scene_arrays(scene);
  const MovingOptions options = moving_options();
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, {.build = options.build, .trace = options.trace});
  const SwarmSlots swarm{layout.add<InstanceTransform>("rest", 100), layout.add_mapped<uint>("turn", 1)};
  LockstepExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, film_of(scene, options));
  executor.upload(swarm.rest, std::span<const InstanceTransform>(arrays.transforms));
  const auto expect_none = [&](const auto& append) {
    const auto difference = executor.run(append);
    ASSERT_FALSE(difference) << difference->stage << ", " << difference->slot << " " << difference->index
                             << ": " << difference->cpu << " and " << difference->gpu;
  };
  expect_none([&](Chain& chain) { append_frame_meshes(chain, plan); });
  for (const double seconds : {0.0, 0.7, 12.0}) {
    const uint turn = turn_at(*scene.swarm, seconds);
    executor.upload(swarm.turn, std::span<const uint>(&turn, 1));
    expect_none([&](Chain& chain) {
      append_moves(chain, plan.levels->plan, swarm, scene.swarm->seed);
      append_top(chain, plan.levels->plan);
      TracePieces pieces = plan.pieces(plan.trace);
      while (!pieces.done()) pieces.append(chain, ~std::uint64_t{0});
    });
  }
}

TEST_F(MovingSwarm, AreTheSameBitsInAnyOrderAndWithAnyNumberUnderWay) {
  const Scene scene = make_instances(60);
  std::vector<std::uint64_t> hashes[2];
  for (const std::uint32_t under_way : {1u, 3u}) {
    MovingOptions options = moving_options();
    options.under_way = under_way;
    MovingFrames frames(test_device(), scene, options);
    const Film film = film_of(scene, options);
    std::vector<std::uint64_t>& mine = hashes[under_way == 3];
    mine.resize(8);
    std::vector<std::size_t> order(8);
    std::iota(order.begin(), order.end(), 0);
    if (under_way == 3) std::reverse(order.begin(), order.end());
    std::size_t taken = 0;
    const auto take = [&] {
      const MovingFrame frame = frames.take();
      EXPECT_TRUE(frame.rebuilt);
      EXPECT_EQ(frame.submits, 1u);
      EXPECT_EQ(frame.state.active_count, 60u);
      mine[order[taken++]] = image_hash(frame.image);
    };
    for (const std::size_t number : order) {
      if (!frames.has_room()) take();
      frames.submit(0.5 * static_cast<double>(number), film);
    }
    while (!frames.is_empty()) take();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0][1], hashes[0][2]);
}

// A frame has one build, that over the instances.
TEST_F(MovingSwarm, LeaveTheMeshesTreesAsTheyAre) {
  const Scene scene = make_instances(30);
  MovingOptions options = moving_options();
  options.tree_cost = true;
  MovingFrames frames(test_device(), scene, options);
  std::size_t builds = 0, moves = 0;
  for (const Step& step : frames.steps()) {
    builds += stage_of(step) == &stages::hploc_build;
    moves += stage_of(step) == &stages::move_instances;
  }
  EXPECT_EQ(builds, 1u);
  EXPECT_EQ(moves, 1u);
  const Slot<Node>& nodes = frames.plan().levels->plan.mesh_nodes;
  const std::vector<Node> before = frames.executor().read(nodes);
  EXPECT_GT(before[0].height, 0u);
  frames.submit(2, film_of(scene, options));
  EXPECT_GT(frames.take().sah, 1);
  const std::vector<Node> after = frames.executor().read(nodes);
  EXPECT_EQ(tree_hash(before), tree_hash(after));
}

TEST_F(MovingSwarm, StandStillWithoutASwarm) {
  Scene scene = make_instances(40);
  const MovingOptions options = moving_options();
  const Film film = film_of(scene, options);
  MovingFrames swarm(test_device(), scene, options);
  scene.swarm.reset();
  MovingFrames still(test_device(), scene, options);
  const std::vector<uint> first = frame_at(swarm, 0, film);
  EXPECT_EQ(frame_at(still, 0, film), first);
  EXPECT_EQ(frame_at(still, 5, film), first);
  for (const Step& step : still.steps())
    EXPECT_NE(stage_of(step), &stages::hploc_build) << "nothing is built";
  still.submit(6, film);
  const MovingFrame kept = still.take();
  EXPECT_TRUE(kept.kept && !kept.rebuilt);
  EXPECT_EQ(kept.state.active_count, 40u);
  EXPECT_NE(frame_at(swarm, 5, film), first);
}

TEST_F(MovingSwarm, HasNoWideTree) {
  const Scene scene = make_instances(3);
  MovingOptions options = moving_options();
  options.trace.walk = Walk::wide_packets;
  EXPECT_THROW(MovingFrames(test_device(), scene, options), std::invalid_argument);
}

TEST_F(MovingSwarm, LikeAGpuGoThroughMappedMemory) {
  expect_same_like_a_gpu(make_instances(50), moving_options(), 1.5);
}

}  // namespace
}  // namespace coppice
