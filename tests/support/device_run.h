#pragma once

#include <span>
#include <vector>

#include "pipeline/build_plan.h"
#include "pipeline/ray_tracing.h"
#include "support/test_device.h"

namespace coppice {

struct BuiltTree {
  std::vector<Node> nodes;
  BuildState state;
  std::uint32_t rounds_bound;
};

// Builds on the device, `runs` times over with one recording; all runs must give the same tree.
BuiltTree build_on(Device& device, std::span<const Triangle> triangles, const BuildOptions& options,
                   int runs = 1);

// Traces rays on the test device through a tree; by brute force where `nodes` is empty.
TracedRays trace_on_device(std::span<const Node> nodes, std::span<const Triangle> triangles,
                           std::span<const Ray> rays, const TraceOptions& options = test_trace_options(1, 1));

}  // namespace coppice
