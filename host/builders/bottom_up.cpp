#include "builders/bottom_up.h"

#include <vector>

#include "builders/leaves.h"
#include "builders/subtree.h"

namespace coppice {

Bvh build_bottom_up(std::span<const Triangle> triangles) {
  std::vector<Node> clusters = make_leaves(triangles);
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(clusters.size());
  if (clusters.empty()) return bvh;
  bvh.nodes.resize(2 * clusters.size() - 1);
  // Pairs fill the nodes from the back. The last pair of a level is written first, so that pairs stand in the
  // order of the list.
  auto next_child = static_cast<std::uint32_t>(bvh.nodes.size());
  while (clusters.size() > 1) {
    ++bvh.rounds;
    const std::size_t pairs = clusters.size() / 2;
    next_child -= static_cast<std::uint32_t>(2 * pairs);
    for (std::size_t i = 0; i < pairs; ++i) {
      const auto child = static_cast<std::uint32_t>(next_child + 2 * i);
      bvh.nodes[child] = clusters[2 * i];
      bvh.nodes[child + 1] = clusters[2 * i + 1];
      clusters[i].child = child;
      fit_to_children(clusters[i], bvh.nodes);
    }
    if (clusters.size() % 2 == 1) clusters[pairs] = clusters.back();
    clusters.resize(pairs + clusters.size() % 2);
  }
  bvh.nodes[0] = clusters[0];
  return bvh;
}

}  // namespace coppice
