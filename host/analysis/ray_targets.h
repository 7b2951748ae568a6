#pragma once

#include <cstdint>
#include <glm/ext/vector_double3.hpp>
#include <span>
#include <vector>

#include "interface/trace.h"

namespace coppice {

// SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
// The same numbers everywhere. Draw more than one only in separate statements or in braces.
class DoubleRandom {
 public:
  explicit DoubleRandom(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // in [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // In [0, count); `count` is at least 1 and below 2^32. Biased by less than count / 2^32.
  std::uint32_t below(std::uint64_t count) {
    return static_cast<std::uint32_t>(((next() >> 32) * count) >> 32);
  }
  bool coin() { return below(2) == 0; }
  glm::dvec3 in_cube();    // [-1, 1)^3
  glm::dvec3 direction();  // unit length

 private:
  std::uint64_t state_;
};

// What rays are aimed at: the active triangles, the boxes of a tree, and the box of it all.
class RayTargets {
 public:
  // Without an active triangle there is one, in the unit cube.
  RayTargets(std::span<const Triangle> triangles, std::span<const Node> nodes);

  const Triangle& triangle(DoubleRandom& random) const;
  Aabb box(DoubleRandom& random) const;  // of a node, or of a triangle where there are no nodes

  glm::dvec3 centre() const { return centre_; }
  double size() const { return size_; }  // half the longest side of the box of it all; above 0

  // Somewhere in and around the scene, or around the triangle at its own scale, by turns of chance. Finite as
  // float.
  vec3 origin(const Triangle& near, DoubleRandom& random) const;

 private:
  std::vector<Triangle> triangles_;  // the active ones
  std::span<const Node> nodes_;
  glm::dvec3 centre_;
  double size_;
};

// The nearest float point, with what is too large moved to the end of the range.
vec3 to_float(const glm::dvec3& point);

// A float direction from the origin to the target: of unit length or, by chance and where floats can hold it,
// of the length of the way. Random where the two coincide.
vec3 aim(const vec3& origin, const glm::dvec3& target, DoubleRandom& random);

// A point of the triangle, by chance: a corner, on an edge, or inside.
glm::dvec3 corner_of(const Triangle& triangle, DoubleRandom& random);
glm::dvec3 edge_point_of(const Triangle& triangle, DoubleRandom& random);
glm::dvec3 inner_point_of(const Triangle& triangle, DoubleRandom& random);

}  // namespace coppice
