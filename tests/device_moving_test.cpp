// Scenes that move: vertices on the device are where the host's computation in double has them, and a frame
// is the picture of the triangles that stand there, whatever came before it.
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "analysis/tree_hash.h"
#include "builders/ploc.h"
#include "scene/generators.h"
#include "stages/lockstep_executor.h"
#include "support/moving_frames.h"
#include "support/moving_scenes.h"
#include "support/scenes.h"
#include "support/test_device.h"

namespace coppice {
namespace {

constexpr double limit = submit_limit_seconds;

struct VertexRun {
  Layout layout;
  MovingVertices vertices;
  MotionSlots told;

  VertexRun(Device& device, const Scene& scene)
      : layout(device.properties().max_block_bytes),
        vertices(plan_vertices(layout, *scene.motion, static_cast<std::uint32_t>(scene.indices.size()))),
        told(plan_motion(layout, *scene.motion)) {}

  template <class Executor>
  void upload(Executor& executor, const Scene& scene, double seconds) const {
    const Motion& motion = *scene.motion;
    upload_vertices(executor, vertices, motion, std::span<const uvec3>(scene.indices));
    upload_step(executor, told, motion_step(motion, pose_at(motion, seconds), seconds));
  }
};

std::vector<vec3> on_device(Device& device, const Scene& scene, double seconds) {
  const VertexRun run(device, scene);
  GpuExecutor executor(device, run.layout);
  run.upload(executor, scene, seconds);
  Chain chain = executor.chain();
  append_vertices(chain, run.vertices, run.told, *scene.motion);
  executor.record(chain.steps()).submit_and_wait(limit);
  const std::vector<float> words = executor.read(run.vertices.vertices);
  std::vector<vec3> positions(words.size() / 3);
  for (std::size_t i = 0; i < words.size(); ++i) positions[i / 3][static_cast<int>(i % 3)] = words[i];
  return positions;
}

// All coordinates are below 20, and no way has more than some fifty roundings of them and turns to 3e-7.
constexpr double vertex_tolerance = 1e-4;

using MovingVerticesTest = DeviceTest;

TEST_F(MovingVerticesTest, AreInLockstepWithTheTwins) {
  for (const std::uint32_t triangles : {1u, 30u, 400u}) {
    const Scene scene = all_that_moves(triangles);
    const VertexRun run(test_device(), scene);
    LockstepExecutor executor(test_device(), run.layout);
    for (const double seconds : {0.0, 0.3, 0.81, 17.25}) {
      run.upload(executor, scene, seconds);
      const auto difference =
          executor.run([&](Chain& chain) { append_vertices(chain, run.vertices, run.told, *scene.motion); });
      ASSERT_FALSE(difference) << difference->stage << ", " << difference->slot << " " << difference->index
                               << " at second " << seconds << ": " << difference->cpu << " and "
                               << difference->gpu;
    }
  }
}

TEST_F(MovingVerticesTest, AreWhereTheHostHasThemInDouble) {
  const Scene scene = all_that_moves(40);
  double most_way = 0;
  for (const double seconds : {0.0, 0.37, 1.9, 4.03, 100.5}) {
    const std::vector<vec3> device = on_device(test_device(), scene, seconds);
    const std::vector<glm::vec3> host = positions_at(*scene.motion, seconds);
    ASSERT_EQ(device.size(), host.size());
    for (std::size_t v = 0; v < host.size(); ++v) {
      ASSERT_LT(glm::length(device[v] - host[v]), vertex_tolerance * (1 + std::fabs(seconds)))
          << "vertex " << v << " at second " << seconds;
      most_way = std::max<double>(most_way, glm::length(host[v] - scene.motion->rest[v]));
    }
  }
  EXPECT_GT(most_way, 1);
}

TEST_F(MovingVerticesTest, WithoutAWayStayTheBitsTheyWere) {
  const Scene grove = make_grove();
  const std::vector<vec3> device = on_device(test_device(), grove, 0);
  for (std::size_t v = 0; v < device.size(); ++v) ASSERT_EQ(device[v], grove.positions[v]) << v;
}

TEST(MotionRanges, ThatOverlapOrLieOutsideAreRefused) {
  const auto plan = [](const Motion& motion) {
    Layout layout;
    plan_vertices(layout, motion, 0);
  };
  Motion motion;
  motion.rest.resize(10);
  motion.deformations = {{.vertices = {0, 5}}, {.vertices = {5, 5}}, {.vertices = {0, 5}}};
  EXPECT_NO_THROW(plan(motion));
  motion.deformations[1].vertices = {4, 6};
  EXPECT_THROW(plan(motion), std::invalid_argument);
  motion.deformations[1].vertices = {5, 6};
  EXPECT_THROW(plan(motion), std::invalid_argument);
  motion.deformations.clear();
  motion.morphs = {{{0, 10}, 0, std::vector<glm::vec3>(10)}};
  EXPECT_THROW(plan(motion), std::invalid_argument) << "no weight";
  motion.morphs.clear();
  motion.joints.resize(10, {1, 0, 0, 0});
  motion.weights.resize(10);
  EXPECT_THROW(plan(motion), std::invalid_argument) << "no joint 1";
}

// A deformation over parts that go other ways before, one of them without vertices.
TEST_F(MovingVerticesTest, ADeformationHasOtherRangesWithinIt) {
  Scene scene = all_that_moves(20);
  auto motion = std::make_shared<Motion>(*scene.motion);
  const auto all = static_cast<std::uint32_t>(motion->rest.size());
  motion->sequences.clear();
  motion->morphs.erase(motion->morphs.begin() + 2, motion->morphs.end());
  motion->deformations = {{.vertices = {0, 0}, .size = 3},
                          {.vertices = {0, all - 60}, .kind = DeformKind::sway, .size = 3, .amount = 0.3f}};
  scene.motion = motion;
  const std::vector<vec3> device = on_device(test_device(), scene, 0.9);
  const std::vector<glm::vec3> host = positions_at(*motion, 0.9);
  for (std::size_t v = 0; v < host.size(); ++v)
    ASSERT_LT(glm::length(device[v] - host[v]), 2 * vertex_tolerance) << v;
  motion->deformations[1].kind = DeformKind::explode;
  Layout layout;
  EXPECT_THROW(plan_vertices(layout, *motion, 0), std::invalid_argument) << "its pieces are counted";
}

// --- Frames.

// The scene as it stands where the moving one is.
Scene stopped_at(const Scene& moving, double seconds) {
  Scene still = moving;
  still.positions = on_device(test_device(), moving, seconds);
  still.motion = nullptr;
  return still;
}

using MovingFramesTest = DeviceTest;

TEST_F(MovingFramesTest, AreThePicturesOfWhatStandsThere) {
  const Scene scene = make_moving(3000);
  for (const Walk walk : {Walk::binary, Walk::wide_packets}) {
    const MovingOptions options =
        moving_options(walk, walk == Walk::binary ? DeviceBuilder::ploc : DeviceBuilder::hploc);
    MovingFrames frames(test_device(), scene, options);
    for (const double seconds : {0.0, 1.1, 3.0}) {
      const auto image = frame_at(frames, seconds, film_of(scene, options));
      EXPECT_EQ(image_hash(image),
                image_hash(still_picture(stopped_at(scene, seconds), film_of(scene, options), options.build,
                                         options.trace)))
          << seconds;
    }
  }
}

TEST_F(MovingFramesTest, AreTheSameBitsInAnyOrderAndWithAnyNumberUnderWay) {
  const Scene scene = all_that_moves(60);
  std::vector<std::uint64_t> hashes[2];
  for (const std::uint32_t under_way : {1u, 3u}) {
    MovingOptions options = moving_options(Walk::binary);
    options.under_way = under_way;
    MovingFrames frames(test_device(), scene, options);
    const Film film = film_of(scene, options);
    std::vector<std::uint64_t>& mine = hashes[under_way == 3];
    mine.resize(8);
    std::vector<std::size_t> order(8);
    std::iota(order.begin(), order.end(), 0);
    if (under_way == 3) std::reverse(order.begin(), order.end());
    std::size_t taken = 0;
    const auto take = [&] { mine[order[taken++]] = image_hash(frames.take().image); };
    for (const std::size_t number : order) {
      if (!frames.has_room()) take();
      frames.submit(0.2 * static_cast<double>(number), film);
    }
    while (!frames.is_empty()) take();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0][1], hashes[0][2]);
}

// Whatever the tree is, the picture is the same; and a refitted tree costs no less than a new one.
TEST_F(MovingFramesTest, AreTheSamePicturesByRefits) {
  for (const Scene& scene : {make_moving(2000), all_that_moves(60)}) {
    for (const Walk walk : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
      MovingOptions options = moving_options(walk);
      MovingFrames built(test_device(), scene, options);
      for (const Update update : {Update::refit, Update::automatic}) {
        options.update = update;
        options.tree_cost = true;
        MovingFrames refitted(test_device(), scene, options);
        const Film film = film_of(scene, options);
        for (int frame = 0; frame < 5; ++frame) {
          refitted.submit(0.3 * frame, film);
          const MovingFrame left = refitted.take();
          EXPECT_EQ(left.submits, 1u);
          if (update == Update::refit) {
            EXPECT_EQ(left.rebuilt, frame == 0);
          }
          EXPECT_GT(left.sah, 1);
          EXPECT_EQ(image_hash(left.image), image_hash(frame_at(built, 0.3 * frame, film))) << frame;
        }
      }
    }
  }
}

// A tree that was built while a triangle was not there has no leaf for it.
TEST_F(MovingFramesTest, AreBuiltWhereTrianglesAppear) {
  Scene scene = all_that_moves(2);
  auto motion = std::make_shared<Motion>();
  motion->rest = scene.positions;
  const auto vertices = static_cast<std::uint32_t>(scene.positions.size());
  VertexSequence sequence{.vertices = {0, vertices}, .frames_per_second = 1};
  for (std::uint32_t frame = 0; frame < 6; ++frame) {
    for (std::uint32_t v = 0; v < vertices; ++v)
      sequence.positions.push_back(v / 3 == 1 && frame < 2 ? glm::vec3{std::nanf("")} : scene.positions[v]);
  }
  motion->sequences = {sequence};
  scene.motion = motion;
  MovingOptions options = moving_options(Walk::wide_packets);
  options.update = Update::refit;
  MovingFrames frames(test_device(), scene, options);
  options.update = Update::rebuild;
  MovingFrames built(test_device(), scene, options);
  const Film film = film_of(scene, options);
  std::vector<std::uint32_t> submits;
  frames.submit(0, film);
  for (int frame = 0; frame < 6; ++frame) {
    if (frame < 5) frames.submit(frame + 1, film);
    const MovingFrame left = frames.take();
    submits.push_back(left.submits);
    EXPECT_EQ(left.state.active_count, vertices / 3 - (frame < 2)) << frame;
    EXPECT_EQ(image_hash(left.image), image_hash(frame_at(built, frame, film))) << frame;
  }
  // Frame 3 was on its way when frame 2 was found to need a build.
  EXPECT_EQ(submits, (std::vector<std::uint32_t>{1, 1, 2, 2, 1, 1}));
}

TEST_F(MovingFramesTest, RefuseWhatHasNoRoom) {
  const Scene scene = make_moving(50);
  MovingOptions options = moving_options(Walk::binary);
  options.under_way = 1;
  MovingFrames frames(test_device(), scene, options);
  EXPECT_THROW(frames.take(), std::logic_error);
  frames.submit(0, film_of(scene, options));
  EXPECT_FALSE(frames.has_room());
  EXPECT_THROW(frames.submit(0, film_of(scene, options)), std::logic_error);
  frames.take();
  options.under_way = 0;
  EXPECT_THROW(MovingFrames(test_device(), scene, options), std::invalid_argument);
}

// Triangles that vanish, one by one up to all of them, and come back; and a mesh that shrinks to a point.
TEST_F(MovingFramesTest, MayLoseAllTriangles) {
  Scene scene = all_that_moves(1);
  auto motion = std::make_shared<Motion>();
  motion->rest = scene.positions;
  const auto vertices = static_cast<std::uint32_t>(scene.positions.size());
  VertexSequence sequence{.vertices = {0, vertices}, .frames_per_second = 1};
  const std::uint32_t triangles = vertices / 3;
  for (std::uint32_t frame = 0; frame <= triangles + 1; ++frame) {
    for (std::uint32_t v = 0; v < vertices; ++v) {
      sequence.positions.push_back(frame > triangles ? glm::vec3{1, 2, 3}
                                   : v / 3 < frame   ? glm::vec3{std::nanf("")}
                                                     : scene.positions[v]);
    }
  }
  motion->sequences = {sequence};
  scene.motion = motion;
  const MovingOptions options = moving_options(Walk::wide_packets);
  MovingFrames frames(test_device(), scene, options);
  const Film film = film_of(scene, options);
  const std::vector<uint> whole = frame_at(frames, 0, film);
  for (std::uint32_t frame = 0; frame <= triangles + 1; ++frame) {
    frames.submit(frame, film);
    const MovingFrame left = frames.take();
    EXPECT_EQ(left.state.active_count, frame > triangles ? triangles : triangles - frame);
    if (frame >= triangles) {
      EXPECT_EQ(left.counts.hits, 0u);
    }
  }
  EXPECT_EQ(frame_at(frames, 0, film), whole);
}

TEST_F(MovingFramesTest, LikeAGpuGoThroughMappedMemory) {
  expect_same_like_a_gpu(make_moving(500), moving_options(Walk::wide_packets), 0.7);
}

}  // namespace
}  // namespace coppice
