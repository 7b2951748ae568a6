#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "render/frame.h"
#include "render/moving_vertices.h"
#include "stages/gpu_executor.h"

namespace coppice {

struct MovingOptions {
  BuildOptions build{};
  TraceOptions trace{};
  std::uint32_t under_way = 2;  // frames that may be on the device or waiting for it; at least 1
};

// What came of a frame, in milliseconds of the device's clock. Parts are 0 where it has none.
struct MovingFrame {
  double seconds = 0;      // of the scene
  double vertices_ms = 0;  // to where they are
  double build_ms = 0;     // triangles, bounds, and the tree
  double wide_ms = 0;
  double trace_ms = 0;  // camera rays to picture
  double total_ms = 0;  // of the submit; of the host's clock where the device has none
  double wall_ms = 0;   // from the submit until the host knew
  TraceCounts counts;
  BuildState state;
  std::span<const uint> image;  // RGBA8; until so many more frames as may be under way have been submitted
};

// A scene's frames, each in one submit: vertices to where they are, triangles, tree, picture. Submits are
// recorded once; what a frame is told goes through as many slots as frames may be under way, and nothing is
// allocated for one. A scene without motion stands still.
class MovingFrames {
 public:
  // Throws DeviceError if the device's memory does not hold it, LayoutError if a slot is too large, and what
  // plan_vertices throws. Device and scene must outlive it.
  MovingFrames(Device& device, const Scene& scene, const MovingOptions& options);
  ~MovingFrames();
  MovingFrames(const MovingFrames&) = delete;

  // Whether another frame may be submitted before one is taken.
  bool has_room() const { return waiting_.size() < slots_.size(); }
  bool is_empty() const { return waiting_.empty(); }

  // The frame of that time. Throws std::logic_error without room, DeviceError if the device fails.
  void submit(double seconds, const Film& film);

  // Waits for the oldest frame. Throws DeviceError if it did not come out.
  MovingFrame take();

  // The steps of one frame, and what they read, for other executors and for timing each kernel.
  const FramePlan& plan() const { return plan_; }
  const Layout& layout() const { return layout_; }
  GpuExecutor& executor() { return executor_; }
  std::vector<Step> steps() const;

 private:
  // Of a frame under way.
  struct Told {
    MotionSlots motion;
    Slot<Film> film;
  };
  struct Left {
    Slot<uint> image;
    Slot<BuildState> state;
    Slot<TraceCounters> counters;
  };
  struct FrameSlots {
    Told told;
    Left left;
  };
  struct Waiting {
    std::size_t slot;
    double seconds;
  };

  static FramePlan plan_all(MovingFrames& frames, const SceneArrays& arrays);
  void append(Chain& chain, const FrameSlots& slots) const;
  template <class T>
  const T* mapped(const Slot<T>& slot);

  Motion motion_;
  MovingOptions options_;
  Layout layout_;
  MovingVertices vertices_;
  std::vector<FrameSlots> slots_;
  FramePlan plan_;
  GpuExecutor executor_;
  std::vector<Recorder> recorders_;  // one a slot
  std::deque<Waiting> waiting_;      // the oldest first
  std::size_t next_slot_ = 0;
};

}  // namespace coppice
