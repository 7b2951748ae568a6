#pragma once

#include "measure/build_report.h"
#include "measure/builder_choice.h"
#include "pipeline/checked_device.h"
#include "pipeline/wide_plan.h"
#include "scene/scene.h"

namespace coppice {

// Fails with DeviceError if the last submit left an error word.
void check_state(const GpuExecutor& executor, const TreeSlots& tree);

// The tree of the last submit, as long as it came out.
std::vector<Node> read_tree(const GpuExecutor& executor, const TreeSlots& tree);

// The wide tree of the last submit, as long as it came out.
std::vector<WideNode> read_wide_tree(const GpuExecutor& executor, const TreeSlots& tree);

// What is known of the scene before any build. Notes where 60 Morton bits were chosen and matter.
BuildReport report_for(const BuilderChoice& builder, const Scene& scene, std::span<const Triangle> triangles,
                       const Note& note);

// Quality and hash of the tree, added to the report.
void describe_tree(BuildReport& report, std::span<const Node> nodes);

// Bytes of all blocks.
std::uint64_t device_bytes(const Layout& layout);

// Where the build of the last submit ran, how, and its tree.
void describe_device_build(const CheckedDevice& device, const GpuExecutor& executor, const BuildPlan& plan,
                           BuildReport& report);

// What the build of the last submit left that the models of its stages need.
RunCounts counts_of_build(const GpuExecutor& executor, const BuildPlan& plan, const WidePlan* wide = nullptr);

// Adds what the conversion to wide nodes left.
void count_wide(const GpuExecutor& executor, const TreeSlots& tree, const WidePlan& wide, RunCounts& counts);

// How a build on the device is measured.
struct BuildRuns {
  std::uint32_t runs = 5;      // after a warm-up
  bool rounds = false;         // and the rounds of PLOC, each by itself
  bool wide = false;           // then the last tree is converted to wide nodes as often, timed by itself
  std::string trace_events{};  // a file; empty: none
};

// Builds, measures, and describes the tree, which `bvh` takes unless it is null.
BuildReport measure_device_build(CheckedDevice& device, std::span<const Triangle> triangles,
                                 const BuildOptions& options, const BuildRuns& runs, BuildReport report,
                                 Bvh* bvh = nullptr);

// The same by a CPU builder, without a warm-up; `bvh` is the tree of the last run.
BuildReport measure_cpu_build(std::span<const Triangle> triangles, BuildReport report, std::uint32_t runs,
                              Bvh& bvh);

}  // namespace coppice
