#include "measure/tree_choice.h"

#include <algorithm>

#include "measure/films.h"
#include "pipeline/interruption.h"

namespace coppice {

namespace {

double least_ms(CheckedDevice& device, const Scene& scene, AnimateRuns runs) {
  runs.last = runs.first;
  runs.update = Update::rebuild;
  runs.tree_cost = runs.split = false;
  runs.picture = nullptr;
  runs.skip = nullptr;
  constexpr int tries = 3;
  double least = 0;
  const double seconds = runs.first / runs.frames_per_second;
  const Film film = Films(scene, runs).at(seconds);
  MovingFrames frames(device.device(), scene, moving_options(device, scene, runs));
  for (int run = 0; run <= tries; ++run) {  // the first compiles the kernels
    throw_if_interrupted();
    frames.submit(seconds, film);
    const MovingFrame frame = frames.take();
    if (run == 1 || (run > 1 && frame.total_ms < least)) least = frame.total_ms;
  }
  return least;
}

}  // namespace

std::vector<TriedTree> choose_tree(CheckedDevice& device, const Scene& scene, AnimateRuns& runs,
                                   const std::vector<std::string>& builders, const std::vector<Walk>& walks) {
  std::vector<TriedTree> tried;
  if (builders.size() < 2 && walks.size() < 2) return tried;
  const InterruptionGuard guard;
  const auto time = [&](const std::string& builder, Walk walk) {
    runs.builder.name = builder;
    runs.trace.walk = walk;
    tried.push_back({builder, walk, least_ms(device, scene, runs)});
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
