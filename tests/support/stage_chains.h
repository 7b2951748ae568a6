#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {

// A few chains that have all stages between them, run in lockstep.
inline constexpr std::uint32_t chain_width = 61, chain_height = 47;  // of their pictures
extern const std::size_t stage_chain_count;

// Spoils the steps of a chain before they run.
using Spoil = std::function<void(std::vector<Step>&, const LockstepExecutor&)>;

struct Found {
  std::optional<Difference> difference;
  std::vector<NearlyListing> nearly;
};

Found run_stage_chain(Device& device, std::size_t chain, const Spoil& spoil);

}  // namespace coppice
