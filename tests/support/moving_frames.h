#pragma once

#include <string>
#include <vector>

#include "render/film.h"
#include "render/moving_frames.h"
#include "support/instances.h"
#include "support/test_device.h"

namespace coppice {

inline MovingOptions moving_options(Walk walk = Walk::binary, DeviceBuilder builder = DeviceBuilder::hploc) {
  MovingOptions options;
  options.trace = test_trace_options(64, 48);
  options.trace.walk = walk;
  options.build.builder = builder;
  return options;
}

inline Film film_of(const Scene& scene, const MovingOptions& options) {
  return make_film(scene, {}, options.trace.width, options.trace.height, options.trace.samples);
}

inline std::vector<uint> frame_at(MovingFrames& frames, double seconds, const Film& film) {
  frames.submit(seconds, film);
  const MovingFrame frame = frames.take();
  return {frame.image.begin(), frame.image.end()};
}

// A frame whose words go through mapped memory has the same picture. In tests with LikeAGpu in their names,
// which run on the reference driver only.
inline void expect_same_like_a_gpu(const Scene& scene, const MovingOptions& options, double seconds) {
  Device like_a_gpu({"", true, true});
  MovingFrames frames(like_a_gpu, scene, options), here(test_device(), scene, options);
  const Film film = film_of(scene, options);
  EXPECT_EQ(frame_at(frames, seconds, film), frame_at(here, seconds, film));
  EXPECT_EQ(like_a_gpu.take_validation_messages(), std::vector<std::string>());
}

// A scene with instances as the last frame had it: where the device has moved instances and vertices.
inline Scene as_moved(Scene scene, MovingFrames& frames) {
  const auto transforms = frames.executor().read(frames.plan().levels->plan.transforms);
  for (std::size_t i = 0; i < transforms.size(); ++i)
    scene.instances[i].transform = columns_of(transforms[i]);
  for (const MovingInstances::Mesh& moved : frames.instances().meshes) {
    InstancedMesh& mesh = scene.meshes[moved.mesh];
    const std::vector<float> words = frames.executor().read(moved.vertices.vertices);
    for (std::size_t i = 0; i < words.size(); ++i)
      scene.positions[mesh.first_vertex + i / 3][static_cast<int>(i % 3)] = words[i];
    mesh.motion = nullptr;
  }
  scene.motion = nullptr;
  scene.swarm.reset();
  return scene;
}

// The picture of a scene that stands still, through one level.
inline std::vector<uint> still_picture(const Scene& still, const Film& film, const BuildOptions& build,
                                       const TraceOptions& trace) {
  const SceneArrays arrays = scene_arrays(still);
  Layout layout(test_device().properties().max_block_bytes);
  const FramePlan plan = plan_frame(layout, arrays, {.build = build, .trace = trace});
  EXPECT_FALSE(plan.levels);
  GpuExecutor executor(test_device(), layout);
  upload_frame(executor, plan, arrays, film);
  Chain chain = executor.chain();
  append_frame(chain, plan);
  executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  EXPECT_EQ(executor.read(plan.tree.state)[0].error_word, 0u);
  return executor.read(plan.trace.image);
}

}  // namespace coppice
