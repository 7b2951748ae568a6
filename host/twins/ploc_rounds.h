#pragma once

#include <span>
#include <vector>

#include "interface/ploc.h"
#include "twins/normalised.h"

namespace coppice::twins {

// How a round is entered: its counts, and the workgroups of its dispatches (none once the finish takes over).
PlocRound make_round(uint cluster_count, uint merged_before, bool pair_all);

// The round after the one with this index, in which `merged` pairs merged.
PlocRound round_after(uint index, const PlocRound& round, uint merged);

// The parent of two clusters, whose children stand at first_child and the place after it.
Node make_parent(const Node& left, const Node& right, uint first_child);

// Where the children of the merge with this rank in the whole build go; the last merge's go to 1 and 2.
uint children_place(uint active_count, uint rank);

// Nearest neighbour of cluster i among its `radius` neighbours on either side; i if it has none.
uint nearest_neighbour(const Aabb* normalised_boxes, uint i, uint cluster_count, uint radius);

// For each cluster of a round the index of the nearest of its `radius` neighbours on either side, or of its
// partner where all pair; its own where it has none.
std::vector<uint> find_neighbours(std::span<const Node> clusters, bool pair_all, uint radius,
                                  const Normalisation& normalise);

}  // namespace coppice::twins
