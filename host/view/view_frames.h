#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/checked_device.h"
#include "pipeline/refit.h"
#include "render/frame.h"
#include "render/moving_instances.h"
#include "render/moving_vertices.h"
#include "render/show.h"
#include "render/update_chooser.h"
#include "stages/gpu_executor.h"
#include "view/opened_scene.h"

namespace coppice {

struct ViewOptions {
  BuilderChoice builder{};
  TraceOptions trace{};  // and of what size; the walk is chosen
  ShowOptions show{};
  Update update = Update::rebuild;  // of the tree, where triangles have moved
  bool refines = false;             // passes are asked for
};

// Device time of kernels that belong together, in the order in which they run.
struct KernelGroup {
  std::string name;
  double ms = 0;
};

struct ViewedFrame {
  bool built = false;               // the tree was made anew
  bool refitted = false;            // or only its boxes
  std::vector<KernelGroup> groups;  // empty on a device without timestamps
  double device_ms = 0;
  std::uint32_t samples = 1;  // a pixel, of all passes so far
  double error = 0;           // of 2 and more: estimated, see picture_error
  TraceCounts counts;         // of the camera's rays; as those below of all passes so far
  TraceCounts shadow;         // of shadow rays
  TraceCounts occlusion;
  TraceCounts bounced;  // of paths behind the camera's rays
  ShowSpan seen;        // of a view with a range
};

struct ViewedTree {
  std::uint64_t nodes = 0, leaves = 0;
  std::uint32_t depth = 0;
  double sah = 0;
  std::vector<std::uint32_t> clusters;  // at the beginning of each round of PLOC
};

// A scene as a window shows it, frame by frame: where its vertices are, its tree and its picture, in two
// submits, between which nothing is waited for unless the view shows values of the tree. So the host makes
// its panes, and the device draws the frame before, while this one is under way. All that does not change
// between frames is recorded once.
class ViewFrames {
 public:
  // The opened scene must outlive it. Throws DeviceError or LayoutError where the device does not hold it.
  ViewFrames(CheckedDevice& device, const OpenedScene& opened, const ViewOptions& options);
  ~ViewFrames();
  ViewFrames(const ViewFrames&) = delete;

  // The picture of that film at that time of the scene, while no other is under way. The tree is made anew
  // where the time is another one, or if asked for; one of the host is made once, and its scene stands still.
  void submit(const Film& film, double seconds, bool rebuild);
  bool is_under_way() const { return under_way_.has_value(); }

  // Another pass of so many samples a pixel over the scene as the last picture has it, of that picture's
  // film. Passes begin anew after each such picture, and are of a sequence, so that however they are cut the
  // picture is that of as many samples. Only where the options ask for passes and the kernels are those of
  // colours.
  void submit_pass(const Film& film, std::uint32_t samples);
  bool can_refine() const { return refined_.has_value(); }

  // Waits for the one under way. Throws DeviceError where it did not come out.
  ViewedFrame take();

  // What is seen of PLOC's rounds from the next frame on, or of the tree's levels.
  void set_show(const ShowOptions& show);

  bool can_move() const { return cycle_of(opened_.scene) && plan_.build.has_value(); }
  Walk walk() const { return plan_.trace.options.walk; }
  ShowSpan span(const Film& film) const;

  // Of the last frame; both are read from the device.
  std::vector<uint> picture() const { return executor_.read(plan_.trace.image); }
  std::vector<Node> tree() const;
  ViewedTree describe() const;

  // Where the picture lies.
  const Slot<uint>& image() const { return plan_.trace.image; }
  VkBuffer image_buffer() { return executor_.arena().buffer(plan_.trace.image.place.block); }

  std::uint64_t device_bytes() const;
  const std::vector<SlotListing>& slots() const { return layout_.slots(); }

 private:
  void upload_scene();
  void append_update(Chain& chain, bool rebuilds) const;
  void tell(double seconds);
  std::uint32_t appeared() const;
  void record_tree(bool rebuilds, std::vector<std::string>& groups, std::optional<Recorder>& recorder);
  void submit_tree(double seconds, bool rebuild);
  bool wait_for_tree();
  void build_after_all();
  static FramePlan plan_instances_of(ViewFrames& frames, FrameOptions options);
  static FramePlan plan_all(ViewFrames& frames, CheckedDevice& device);
  static std::optional<TracePlan> plan_passes(ViewFrames& frames);
  void record();
  void upload_values();
  void check_errors() const;
  void read_counts(ViewedFrame& frame) const;
  void take_pass(ViewedFrame& frame);
  static void wait(Recorder& recorder, const std::vector<std::string>& names, ViewedFrame& frame);

  struct UnderWay {
    double seconds = 0;
    bool has_tree = false;  // submitted, and not waited for
    bool is_pass = false;
    bool in_vain = false;  // it was refitted, and then had to be built
    ViewedFrame frame{};   // as far as it is known
  };

  const OpenedScene& opened_;
  ViewOptions options_;
  std::uint32_t morton_bits_;
  Motion motion_;
  Layout layout_;
  MovingVertices vertices_;
  MotionSlots at_;
  MovingInstances instances_;  // of a scene with instances, in the place of the two above
  InstancesTold instances_at_;
  std::optional<RefitPlan> refit_;  // as what stands above, planned with plan_
  FramePlan plan_;
  std::optional<TracePlan> refined_;  // added to the layout behind it
  GpuExecutor executor_;
  UpdateChooser chooser_;
  std::optional<Recorder> tree_recorder_, refit_recorder_, trace_recorder_, pass_recorder_;
  // One a mark, and one for what is behind the last.
  std::vector<std::string> tree_groups_, refit_groups_, trace_groups_, pass_groups_;
  std::optional<double> seconds_;  // of the tree
  std::optional<UnderWay> under_way_;
  std::uint32_t passed_samples_ = 0;  // of the passes so far
  bool values_old_ = true;            // what is shown of primitives
};

}  // namespace coppice
