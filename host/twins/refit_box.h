#pragma once

#include "interface/refit.h"

namespace coppice::twins {

bool is_active(const Triangle& triangle);

// Gives an inner node the box of its children, and those of them that are leaves that of their triangles.
void refit_node(Address<Node> nodes, Address<const Triangle> triangles, uint index);

// The same of a leaf.
void refit_leaf(Node& leaf, Address<const Triangle> triangles);

// Triangles among which some may be in no leaf: none where the tree has all.
uint absent_limit(const BuildState& state, uint triangle_count);

}  // namespace coppice::twins
