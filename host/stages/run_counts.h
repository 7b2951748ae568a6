#pragma once

#include <cstdint>
#include <vector>

#include "interface/ploc.h"
#include "interface/refit.h"
#include "interface/wide.h"

namespace coppice {

// Rays by which paths have gone on, by the lobe of the surface.
struct LobeCounts {
  std::uint64_t diffuse = 0, reflected = 0, transmitted = 0;
};

// What a run left on the device that decides how many bytes its stages moved.
struct RunCounts {
  std::uint32_t active_count = 0;              // triangles in the tree
  std::uint32_t primitive_count = UINT32_MAX;  // where steps take their number from the device: that number
  std::vector<PlocRound> rounds;  // every entered round, the last with one cluster; empty: no build
  std::uint32_t wide_nodes = 0;
  std::vector<WideLevel> wide_levels;           // all of them; behind them none or empty ones
  std::vector<RefitLevel> refit_levels;         // the same of refits
  std::uint64_t rays = 0, hits = 0, steps = 0;  // of the whole trace
  // Of its shadow rays. `could_be`: so many they were if every ray had one for each light that casts shadows,
  // or at each bounce. The same of occlusion rays, and of paths behind the camera's rays.
  struct Secondary {
    std::uint64_t could_be = 0, rays = 0, hits = 0, steps = 0;
  };
  Secondary shadow, occlusion, paths;
  LobeCounts lobes;  // of paths
};

}  // namespace coppice
