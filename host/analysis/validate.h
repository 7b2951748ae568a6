#pragma once

#include <optional>
#include <span>
#include <string>

#include "interface/types.h"

namespace coppice {

// What a builder promises beyond a correct tree.
struct TreePromises {
  // A triangle may stand in several leaves, each of them holding a part of it (spatial splits).
  bool splits_triangles = false;
  // Each internal box is exactly the union of its children's, and unless triangles are split each leaf's box
  // exactly that of its triangle. Otherwise boxes may be larger.
  bool tight_boxes = true;
  // Its boxes were made anew after its triangles had moved: a leaf may hold an inactive triangle, with the
  // box NOTHING_BOX (interface/refit.h), and so may be the box of a node that has none but such below it.
  bool refitted = false;
};

// Names the first fault of a tree, or none where the tree is valid:
// - no node where no triangle is active; else the root at 0, 2 * leaves - 1 nodes, and each node reached
//   exactly once, siblings being neighbours;
// - each active triangle in a leaf, in one only unless split, and no inactive one (with a non-finite corner);
// - heights 0 at leaves and 1 + the larger height of the children elsewhere;
// - box_min <= box_max and no NaN; each box contains its children's; each corner of a triangle lies in the
//   box of a leaf that holds it.
// Takes any array, however broken, and ends after each node has been seen once.
std::optional<std::string> find_fault(std::span<const Node> nodes, std::span<const Triangle> triangles,
                                      const TreePromises& promises = {});

}  // namespace coppice
