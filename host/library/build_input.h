#pragma once

#include "coppice/build.h"
#include "pipeline/build_plan.h"
#include "pipeline/primitives.h"

namespace coppice {

BuildOptions to_build_options(const TreeOptions& options);

// Throw ArgumentError for addresses, strides and types that cannot be.
BuildInput to_build_input(const TriangleInput& input);
BuildInput to_build_input(const BoxInput& input);

}  // namespace coppice
