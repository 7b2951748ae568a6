#pragma once

#include <cstdint>
#include <span>

namespace coppice {

// Tells whether two files have the same faces, whatever triangles each is cut into: 64 bits of all faces,
// their places in the file and their corners. Faces may be added in any order and by parts, so that a file
// that is read in parallel has the same one. Two lists of faces with the same digest are, for what it is used
// for, the same: other ones meet with a chance of 2^-64.
class FaceDigest {
 public:
  void add(std::uint64_t face, std::span<const std::uint32_t> corners) {
    std::uint64_t hash = mixed(face + (std::uint64_t{corners.size()} << 40));
    for (const std::uint32_t corner : corners) hash = mixed(hash ^ corner);
    sum_ += hash;
  }
  void add(const FaceDigest& others) { sum_ += others.sum_; }

  std::uint64_t value() const { return sum_; }

 private:
  // A bijection: the finaliser of S. Vigna's SplitMix64 (2014), after D. Stafford's "Mix13".
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return x ^ x >> 31;
  }

  std::uint64_t sum_ = 0;
};

}  // namespace coppice
