#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure/build_report.h"
#include "measure/builder_choice.h"
#include "measure/steady_state.h"
#include "pipeline/checked_device.h"
#include "render/moving_frames.h"

namespace coppice {

// A tree that was tried, and what the first frame took with it.
struct TriedTree {
  std::string builder;
  Walk walk;
  double ms;
};

// Which frames of a scene, and how. Frame k is that of second k / frames_per_second.
struct AnimateRuns {
  BuilderChoice builder{};
  TraceOptions trace{};
  Update update = Update::rebuild;
  bool tree_cost = false;        // the SAH cost of every frame's tree
  std::vector<double> camera{};  // see given_view; empty: the scene's, as it moves
  std::uint32_t first = 0, last = 0;
  double frames_per_second = 30;
  // Whether a frame is left out, because it is there already.
  std::function<bool(std::uint32_t)> skip{};
  // Takes each picture as soon as it is done, RGBA8.
  std::function<void(std::uint32_t, std::span<const uint>)> picture{};
  bool split = false;  // the last frame once more, for the times of kernels
  std::string trace_events{};
  std::vector<TriedTree> tried{};  // before; see tree_choice.h
};

// A frame, as it went.
struct AnimatedFrame {
  std::uint32_t number;
  double frame_ms;  // since the one before was done; of the first one its submit
  double vertices_ms, update_ms, wide_ms, trace_ms, device_ms;
  bool rebuilt;
  double sah;  // 0 unless asked for
  std::uint32_t active_count;
  std::uint64_t rays, hits, steps;  // of the camera's rays
  std::uint64_t shadow_rays, shadow_hits;
  std::uint64_t occlusion_rays;
  LobeCounts lobes;    // rays of paths behind those of the camera
  std::uint64_t hash;  // of the picture
};

struct AnimateReport {
  std::string scene, builder, device, driver;
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t instances = 0;  // of meshes that have these triangles
  std::uint32_t morton_bits = 30, width = 0, height = 0;
  Walk walk = Walk::binary;
  std::vector<TriedTree> tried;
  double frames_per_second = 0;
  Update update = Update::rebuild;
  bool tree_cost = false;
  std::vector<AnimatedFrame> frames;
  std::uint32_t skipped = 0;
  std::uint64_t host_waits = 0, rebuilds = 0, refits = 0, device_bytes = 0;
  KernelTable kernels;  // of one frame, if asked for
};

// Each frame in one submit, the next one told while one is under way. The kernels are compiled before, by the
// first frame, which then comes again. `arrays` are the scene's, with the effects that are wanted. Throws
// Interrupted on SIGINT or SIGTERM between two frames.
AnimateReport animate(CheckedDevice& device, const Scene& scene, SceneArrays arrays, const AnimateRuns& runs);

// What a frame of these runs is made with. `morton_bits`: as BuilderChoice::bits_for has them, of the scene.
MovingOptions moving_options(const CheckedDevice& device, const AnimateRuns& runs, std::uint32_t morton_bits);

// As --update has it.
const char* word_of_update(Update update);

Json to_json(const AnimateReport& report);
std::string text_of(const AnimateReport& report);
// Frame by frame, comma-separated.
std::string to_csv(const AnimateReport& report);
// Curves of times over the frames.
std::string to_svg(const AnimateReport& report);

}  // namespace coppice
