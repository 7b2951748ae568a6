#pragma once

#include <string>
#include <vector>

#include "measure/animate.h"

namespace coppice {

// From so many frames on it pays to try trees first.
inline constexpr std::uint32_t frames_worth_trying = 30;

// Of builders and walks that are left open those with which the first frame takes least: build, wide nodes
// and trace, the least of three runs each. The walk first, with the first of the builders, then the builder.
// Pictures do not depend on either (with the watertight and the robust test). Sets both in `runs`, and
// returns what was tried; nothing where nothing is open. Arrays and what it throws are those of animate.
std::vector<TriedTree> choose_tree(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                                   AnimateRuns& runs, const std::vector<std::string>& builders,
                                   const std::vector<Walk>& walks);

}  // namespace coppice
