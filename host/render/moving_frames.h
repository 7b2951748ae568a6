#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/refit.h"
#include "render/frame.h"
#include "render/moving_instances.h"
#include "render/moving_vertices.h"
#include "render/update_chooser.h"
#include "stages/gpu_executor.h"

namespace coppice {

struct MovingOptions {
  BuildOptions build{};
  TraceOptions trace{};
  EffectChanges effects{};      // beside what the scene calls for
  std::uint32_t under_way = 2;  // frames that may be on the device or waiting for it; at least 1
  Update update = Update::rebuild;
  bool tree_cost = false;  // the SAH cost of every frame's tree, which takes time
};

// What came of a frame, in milliseconds of the device's clock. Parts are 0 where it has none.
struct MovingFrame {
  double seconds = 0;         // of the scene
  double vertices_ms = 0;     // to where they are; or instances
  double update_ms = 0;       // triangles, and the tree built or refitted; or boxes of instances and the tree
  double wide_ms = 0;         // and of the tree's cost
  double trace_ms = 0;        // camera rays to picture
  double total_ms = 0;        // of the submit; of the host's clock where the device has none
  double wall_ms = 0;         // from the submit until the host knew
  bool rebuilt = true;        // else refitted, or kept
  bool kept = false;          // nothing of a scene with instances moves: its trees are those it began with
  std::uint32_t submits = 1;  // 2: triangles appeared that the tree of a refit has no leaves for
  TraceCounts counts;         // of the camera's rays
  TraceCounts shadow;         // of shadow rays
  TraceCounts occlusion;      // of occlusion rays
  TraceCounts bounced;        // of paths behind the camera's rays
  LobeCounts lobes;           // the same by the lobe of the surface
  BuildState state;
  double sah = 0;               // of the tree; 0 unless asked for
  std::span<const uint> image;  // RGBA8; until so many more frames as may be under way have been submitted
};

// A scene's frames, each in one submit: vertices to where they are, triangles, tree, picture. Of a scene with
// instances, whose meshes get their trees before the first frame if they stand still: vertices and trees of
// those that deform, transforms, boxes and the tree over the instances, picture. The tree is that of the
// frame, built, or that of the last build, refitted; the picture is the same (with the watertight and the
// robust test, as it does not depend on the tree). Submits are recorded once; what a frame is told goes
// through as many slots as frames may be under way. A scene without motion stands still.
class MovingFrames {
 public:
  // Throws DeviceError if the device's memory does not hold it or a mesh's tree does not come out,
  // LayoutError if a slot is too large, and what plan_vertices and plan_frame throw. Device and scene must
  // outlive it; the scene's arrays, with the effects that are wanted, need not.
  MovingFrames(Device& device, const Scene& scene, const SceneArrays& arrays, const MovingOptions& options);
  // With the arrays of the options' effects; nobody is told of their warnings.
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

  // As if no frame had been: what those before took is forgotten, and the next one is built.
  void forget_times() { chooser_ = chooser(); }

  // The steps of the last frame that was submitted, and what they read, for other executors and for timing
  // each kernel.
  const FramePlan& plan() const { return plan_; }
  const MovingInstances& instances() const { return instances_; }
  const Layout& layout() const { return layout_; }
  GpuExecutor& executor() { return executor_; }
  std::vector<Step> steps(bool rebuilds = true) const;

  // The same of a frame that builds, in one part for each tree that it builds.
  struct Part {
    std::vector<Step> steps;
    BuildPlan build;
  };
  std::vector<Part> parts() const;

 private:
  // Of a frame under way.
  struct Told {
    MotionSlots motion;
    InstancesTold instances;
    Slot<Film> film;
  };
  struct Left {
    Slot<uint> image;
    Slot<BuildState> state;
    Slot<TraceCounters> counters;
    Slot<TraceCounters> shadow, occlusion, bounced;
    Slot<PathCounters> lobes;
    Slot<RefitState> refit;
    InstancesLeft instances;
  };
  struct FrameSlots {
    Told told;
    Left left;
  };
  struct Waiting {
    std::size_t slot;
    double seconds;
    bool rebuilds;
  };

  static FramePlan plan_all(MovingFrames& frames, const SceneArrays& arrays);
  void append(Chain& chain, const FrameSlots& slots, bool rebuilds) const;
  void append_places(Chain& chain, const Told& told) const;
  void append_update(Chain& chain, bool rebuilds) const;
  void append_picture(Chain& chain, const FrameSlots& slots) const;
  const FrameSlots& last_slots() const { return slots_[(next_slot_ + slots_.size() - 1) % slots_.size()]; }
  void append_tree(Chain& chain, bool rebuilds) const;
  void upload_scene(const SceneArrays& arrays);
  void build_what_stands_still();
  void tell(const Told& told, double seconds, const Film& film);
  UpdateChooser chooser() const;
  bool may_refit() const { return options_.update != Update::rebuild; }
  bool has_state() const { return may_refit() || options_.tree_cost; }
  MovingFrame outcome(const Recorder::Times& times, const Left& left);
  std::uint32_t appeared(const Left& left);
  template <class T>
  const T* mapped(const Slot<T>& slot);

  const Scene& scene_;
  Motion motion_;
  MovingOptions options_;
  Layout layout_;
  MovingVertices vertices_;    // empty of a scene with instances, as what they are told
  MovingInstances instances_;  // empty without
  std::vector<FrameSlots> slots_;
  RefitPlan refit_;  // empty where no frame is refitted; as what stands above, planned with plan_
  FramePlan plan_;
  GpuExecutor executor_;
  std::vector<Recorder> builds_, refits_;  // one of each a slot; no refits where none may be
  bool measures_;                          // the device has timestamps
  UpdateChooser chooser_;
  std::deque<Waiting> waiting_;  // the oldest first
  std::size_t next_slot_ = 0;
};

}  // namespace coppice
