#pragma once

#include <optional>
#include <span>
#include <string>

#include "measure/json.h"
#include "render/frame.h"
#include "stages/lockstep_executor.h"

namespace coppice {

// What came of a frame in lockstep. The executor must outlive it.
struct LockstepReport {
  std::uint32_t triangles = 0, rounds_bound = 0, stages_run = 0;
  BuildState state{};
  std::optional<Difference> difference{};
  std::span<const NearlyListing> nearly{};  // what a GPU left nearly equal
};

LockstepReport lockstep_report(const LockstepExecutor& executor, std::optional<Difference> difference,
                               const FramePlan& plan);
Json to_json(const LockstepReport& report);
std::string text_of(const LockstepReport& report, const std::string& scene, const std::string& device);

}  // namespace coppice
