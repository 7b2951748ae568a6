#pragma once

#include <cstdint>
#include <span>

#include "builders/bvh.h"
#include "builders/reference_tree.h"

namespace coppice {

struct Gd16Config {
  ReferenceCap reference_cap = {};
  // Subtrees that the paper would make a leaf are not split by cost any further; see build_gd16.
  bool early_termination = false;
  std::uint32_t leaf_references = 8;  // with early termination: the most in such a subtree
  std::uint32_t threads = 0;          // 0: as many as the machine runs at once
};

// Spatial splits guided by the SAH, after Ganestam and Doggett, "SAH guided spatial split partitioning for
// fast BVH construction", Computer Graphics Forum 35(2), 2016, in the version of the report that Coppice
// finishes: one plane a node, down to leaves of one reference.
//
// The plane stands in the middle of the bounds of the references' midpoints, across their longest axis.
// References on one side of it go there (D_L, D_R). Of those that it crosses either each goes whole to the
// side of its midpoint (O_L, O_R) or both clipped parts go to their sides (S_L, S_R), whichever is cheaper by
// surface area times references, summed over both sides; on a tie they go whole. A triangle's midpoint is
// that of its reference's box. Where all midpoints coincide, or the plane leaves a side empty, the first half
// of the references, in their order, goes left.
//
// Triangles are not split where the subtree has fewer spare references left than the plane crosses
// (ReferenceCap); `reference_cap_reached` tells that such a split would have been cheaper.
//
// The tree is a pure function of triangles and config, whatever the number of threads.
//
// Early termination: the paper makes a leaf of N references where testing all, E_t = C_t A(n) N, costs no
// more than the split, C_i A(n) + C_t (A(left) N_left + A(right) N_right); C_i = C_t = 1. A Node has no
// count, so such a leaf cannot be stored as one: it becomes a subtree of the same references, unclipped from
// there on and divided by halves. The references, and the work of clipping and of costs, are those of
// such leaves; node count and SAH cost are those of the subtrees.
//
// Throws std::invalid_argument for a reference cap below one a triangle, std::length_error for more than
// 2^31 - 1 triangles.
Bvh build_gd16(std::span<const Triangle> triangles, const Gd16Config& config = {});

}  // namespace coppice
