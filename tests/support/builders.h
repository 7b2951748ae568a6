#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <string>

#include "analysis/validate.h"
#include "builders/bvh.h"

namespace coppice {

inline void expect_valid(const Bvh& bvh, std::span<const Triangle> triangles) {
  EXPECT_EQ(find_fault(bvh.nodes, triangles).value_or("no fault"), "no fault");
}

// Bit for bit, signs of zero included.
inline bool same_nodes(const Bvh& a, const Bvh& b) {
  return a.nodes.size() == b.nodes.size() &&
         (a.nodes.empty() || std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(Node)) == 0);
}

}  // namespace coppice
