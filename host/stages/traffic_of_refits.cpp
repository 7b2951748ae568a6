#include <algorithm>

#include "stages/divide_up.h"
#include "stages/stages.h"

// What the stages of refits move at least: "cost" in docs/kernels.md.
namespace coppice::traffic {

namespace {

Bytes inner_nodes(const RunCounts& counts) { return counts.active_count == 0 ? 0 : counts.active_count - 1; }
Bytes nodes_of_tree(const RunCounts& counts) {
  return counts.active_count == 0 ? 0 : 2 * inner_nodes(counts) + 1;
}

// None where all triangles are in leaves.
Bytes looked_at(Bytes planned, const RunCounts& counts) {
  const Bytes count = std::min<Bytes>(planned, counts.primitive_count);
  return counts.active_count < count ? count : 0;
}

Bytes inner_nodes_of(std::uint32_t level, const RunCounts& counts) {
  return level < counts.refit_levels.size() ? counts.refit_levels[level].count : 0;
}

// Those of the first level have leaves alone, and the others share the rest of them.
Bytes leaves_below(std::uint32_t level, const RunCounts& counts) {
  const Bytes first = inner_nodes_of(0, counts), others = inner_nodes(counts) - first;
  if (level == 0 || others == 0) return level == 0 ? 2 * first : 0;
  return (counts.active_count - 2 * first) * inner_nodes_of(level, counts) / others;
}

// A node's pair is read, and the node and those of the pair that are leaves are written.
Bytes refitted_bytes(std::uint32_t level, const RunCounts& counts) {
  return inner_nodes_of(level, counts) * (4 + 3 * sizeof(Node)) +
         leaves_below(level, counts) * (sizeof(Triangle) + sizeof(Node));
}

}  // namespace

Bytes refit_keys(const RefitKeysArgs&, const RunCounts& counts) {
  return nodes_of_tree(counts) * sizeof(Node) + inner_nodes(counts) * 8;
}

Bytes refit_levels(const RefitLevelsArgs&, const RunCounts&) {
  return (REFIT_MAX_HEIGHT + 1) * (sizeof(RefitLevel) + 4);
}

Bytes refit_absent(const RefitAbsentArgs& a, const RunCounts& counts) {
  const Bytes triangles = looked_at(a.triangle_count, counts);
  return triangles * sizeof(Triangle) + triangles / 8;
}

// Of the triangles that have no leaf.
Bytes refit_appeared(const RefitAppearedArgs& a, const RunCounts& counts) {
  const Bytes triangles = looked_at(a.triangle_count, counts);
  return triangles == 0 ? 0 : triangles / 8 + (triangles - counts.active_count) * sizeof(Triangle);
}

Bytes refit_boxes(const RefitBoxesArgs& a, const RunCounts& counts) {
  return refitted_bytes(a.level, counts);
}

Bytes refit_rest(const RefitRestArgs& a, const RunCounts& counts) {
  if (counts.active_count == 1) return sizeof(Triangle) + 2 * sizeof(Node);
  Bytes bytes = 0;
  for (std::uint32_t level = a.level; level < REFIT_MAX_HEIGHT; ++level)
    bytes += refitted_bytes(level, counts);
  return bytes;
}

Bytes tree_areas(const TreeAreasArgs&, const RunCounts& counts) {
  return nodes_of_tree(counts) * sizeof(Node) +
         divide_up(nodes_of_tree(counts), TREE_AREAS_TILE) * sizeof(float);
}

Bytes tree_area_sum(const TreeAreaSumArgs&, const RunCounts& counts) {
  return divide_up(nodes_of_tree(counts), TREE_AREAS_TILE) * sizeof(float) + sizeof(Node);
}

}  // namespace coppice::traffic
