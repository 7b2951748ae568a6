#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"

namespace coppice {

class Threads;

// How many references a tree may have, of which each leaf holds one: at most per_triangle * active triangles
// + constant, and never more than 2^31 - 1.
struct ReferenceCap {
  double per_triangle = 2.0;  // at least 1
  std::uint32_t constant = 64;
};

// A reference is the leaf that it becomes: a triangle and the box of a part of it.
using Reference = Node;

// The references of a node to be split.
struct ReferenceSet {
  std::span<const Reference> references;  // at least two
  std::uint32_t spare;                    // how many more of them the subtree may have
  // The threads that split the node together; none where it is the caller's alone.
  const Threads* together = nullptr;
};

// Where a splitter puts the references of both children.
class SplitSides {
 public:
  // There is room for all references and the spare ones.
  SplitSides(Reference* begin, Reference* end) : begin_(begin), end_(end) { clear(); }

  void push_left(const Reference& reference) { *left_end_++ = reference; }
  void push_right(const Reference& reference) { *--right_begin_ = reference; }
  void clear() {
    left_end_ = begin_;
    right_begin_ = end_;
  }

  std::span<Reference> left() const { return {begin_, left_end_}; }
  std::span<Reference> right() const { return {right_begin_, end_}; }

  bool cap_reached = false;  // a split was given up because its references were too many
  bool halve_below = false;  // the subtrees are finished by halves, without the splitter

 private:
  Reference* begin_;
  Reference* end_;
  Reference* left_end_;
  Reference* right_begin_;
};

// The idea of a top-down builder: how one node is split. Called from several threads at once.
class ReferenceSplitter {
 public:
  virtual ~ReferenceSplitter() = default;

  // Puts each reference on one side, or parts of it that together hold all of it on both; at most `spare`
  // more than there were. Where a side is left empty, or none of them is filled, the caller puts the first
  // half of the references, in their order, on the left and the rest on the right.
  virtual void split(const ReferenceSet& set, SplitSides& sides) const = 0;
};

// The greatest height of a tree. Near it nodes are split into halves, whatever the splitter says.
inline constexpr std::uint32_t REFERENCE_TREE_MAX_HEIGHT = 200;

// Splits the leaves of all active triangles top-down until each node holds one reference: nodes of many
// references one after the other by all threads together (0: as many as the machine runs at once), the
// subtrees below them at once. Then come `rotation_passes` passes of tree rotations
// (reference_tree_rotations.h) over each of these subtrees.
//
// Each subtree has a share of the spare references that depends on nothing outside of the way to it, so the
// tree is a pure function of the triangles, the cap, the splitter and the passes, for every number of
// threads. Internal boxes are the unions of their children's; nodes are in depth-first order. Throws
// std::invalid_argument for a cap out of range and std::length_error for more than 2^31 - 1 triangles.
Bvh build_reference_tree(std::span<const Triangle> triangles, const ReferenceCap& cap,
                         const ReferenceSplitter& splitter, std::uint32_t thread_count,
                         std::uint32_t rotation_passes = 0);

}  // namespace coppice
