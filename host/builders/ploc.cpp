#include "builders/ploc.h"

#include <stdexcept>
#include <string>

#include "builders/ploc_clustering.h"
#include "builders/ploc_parallel.h"

namespace coppice {
namespace {

void require_valid(std::uint32_t radius, std::uint32_t morton_bits) {
  if (radius < 1 || radius > PLOC_MAX_RADIUS) {
    throw std::invalid_argument("PLOC radius " + std::to_string(radius) + " is not in 1 to " +
                                std::to_string(PLOC_MAX_RADIUS));
  }
  if (morton_bits != 30 && morton_bits != 60) {
    throw std::invalid_argument("Morton codes of " + std::to_string(morton_bits) +
                                " bits: there are 30 and 60");
  }
}

}  // namespace

Bvh build_ploc_parallel(std::span<const Triangle> triangles, const PlocParallelConfig& config) {
  require_valid(config.radius, config.morton_bits);
  const Threads threads(config.threads);
  MortonLeaves leaves = make_morton_leaves(triangles, config.morton_bits, threads);
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(leaves.count());
  if (leaves.count() == 0) return bvh;

  PlocClustering clustering(std::move(leaves), config.radius, threads);
  bool pairing = false;
  while (clustering.count() > 1) {
    const std::size_t count = clustering.count();
    const std::size_t merged = pairing ? clustering.merge_pairs() : clustering.merge_nearest();
    ++bvh.rounds;
    const bool behind =
        std::uint64_t{clustering.count()} << bvh.rounds / PLOC_EPOCH_ROUNDS > bvh.active_count;
    pairing = behind || merged * PLOC_SLOW_ROUND < count;
  }
  bvh.nodes = clustering.take_nodes();
  return bvh;
}

Bvh build_ploc(std::span<const Triangle> triangles, const PlocConfig& config) {
  return build_ploc_parallel(triangles, {config.radius, config.morton_bits, 1});
}

}  // namespace coppice
