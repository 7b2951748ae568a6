#pragma once

#include "apps/open_device.h"
#include "apps/report.h"
#include "builders/bvh.h"
#include "pipeline/wide.h"
#include "scene/scene.h"

namespace coppice {

// Fails with DeviceError if the last submit left an error word.
void check_state(const GpuExecutor& executor, const TreeSlots& tree);

// The tree of the last submit, as long as it came out.
std::vector<Node> read_tree(const GpuExecutor& executor, const TreeSlots& tree);

// The wide tree of the last submit, as long as it came out.
std::vector<WideNode> read_wide_tree(const GpuExecutor& executor, const TreeSlots& tree);

// What the options say, and for "auto" what the scene calls for (choose_morton_bits): the same for builders
// on the device and on the host. `triangles`: those of scene_arrays.
std::uint32_t morton_bits_for(const Options& options, std::span<const Triangle> triangles);

// What is known of the scene before any build. Says on stderr where 60 Morton bits were chosen and matter.
BuildReport report_for(const Options& options, const Scene& scene, std::span<const Triangle> triangles);

// Quality and hash of the tree, added to the report.
void describe_tree(BuildReport& report, std::span<const Node> nodes);

// What the build of the last submit left that the models of its stages need.
RunCounts counts_of_build(const GpuExecutor& executor, const BuildPlan& plan, const WidePlan* wide = nullptr);

// Adds what the conversion to wide nodes left.
void count_wide(const GpuExecutor& executor, const TreeSlots& tree, const WidePlan& wide, RunCounts& counts);

// Builds options.runs times after a warm-up, measures, and describes the tree. `trace_events` may be empty.
// With a plan for wide nodes the last tree is then converted as often, timed by itself.
BuildReport measure_gpu_build(CheckedDevice& device, GpuExecutor& executor, const BuildPlan& plan,
                              BuildReport report, const Options& options, const WidePlan* wide = nullptr);

// The same by a CPU builder, without a warm-up; `bvh` is the tree of the last run.
BuildReport measure_cpu_build(std::span<const Triangle> triangles, BuildReport report, std::uint32_t runs,
                              Bvh& bvh);

}  // namespace coppice
