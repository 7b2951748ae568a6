#include "measure/tree_choice.h"

#include <algorithm>
#include <limits>

#include "measure/films.h"
#include "pipeline/interruption.h"

namespace coppice {

namespace {

// Of runs of the frame, but for the first one, which compiles the kernels.
double least_ms(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                const MovingOptions& options, double seconds, const Film& film) {
  constexpr int tries = 3;
  double least = std::numeric_limits<double>::infinity();
  MovingFrames frames(device.device(), scene, arrays, options);
  for (int run = 0; run <= tries; ++run) {
    throw_if_interrupted();
    frames.submit(seconds, film);
    const double ms = frames.take().total_ms;
    if (run > 0) least = std::min(least, ms);
  }
  return least;
}

}  // namespace

std::vector<TriedTree> choose_tree(CheckedDevice& device, const Scene& scene, const SceneArrays& arrays,
                                   AnimateRuns& runs, const std::vector<std::string>& builders,
                                   const std::vector<Walk>& walks) {
  std::vector<TriedTree> tried;
  if (builders.size() < 2 && walks.size() < 2) return tried;
  const InterruptionGuard guard;
  const double seconds = runs.first / runs.frames_per_second;
  const Film film = Films(scene, runs).at(seconds);
  const std::uint32_t morton_bits = runs.builder.bits_for(arrays.triangles);
  const auto time = [&](const std::string& builder, Walk walk) {
    runs.builder.name = builder;
    runs.trace.walk = walk;
    MovingOptions options = moving_options(device, runs, morton_bits);
    options.update = Update::rebuild;
    options.tree_cost = false;
    tried.push_back({builder, walk, least_ms(device, scene, arrays, options, seconds, film)});
  };
  const auto best = [&] { return *std::ranges::min_element(tried, {}, &TriedTree::ms); };
  for (const Walk walk : walks) time(builders.front(), walk);
  const Walk walk = best().walk;
  for (std::size_t i = 1; i < builders.size(); ++i) time(builders[i], walk);
  runs.builder.name = best().builder;
  runs.trace.walk = best().walk;
  return tried;
}

}  // namespace coppice
