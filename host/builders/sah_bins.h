#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "builders/lane_box.h"
#include "builders/lanes.h"
#include "interface/types.h"

namespace coppice {

// The bins of the centres along each axis.
class BinGrid {
 public:
  BinGrid(const LaneBox& centre_bounds, std::uint32_t bin_count, float scale);

  std::uint32_t bin_count() const { return bin_count_; }
  // A centre outside of the bounds given must not be asked for.
  Integers bins_of(const LaneBox& box) const {
    return __builtin_convertvector((scaled_centre(box, scale_) - low_) * bins_per_unit_, Integers);
  }
  // Whether there is more than one bin in use, on any axis.
  bool is_flat() const { return is_flat_; }

 private:
  Floats low_;
  Floats bins_per_unit_;  // 0 along axes on which the centres are one
  float scale_;
  std::uint32_t bin_count_;
  bool is_flat_;
};

struct BinSplit {
  int axis;
  std::int32_t first_bin;  // of the second part
};

// The boxes and counts of the triangles in each bin of each axis.
class Bins {
 public:
  static constexpr std::uint32_t LIMIT = 32;

  explicit Bins(std::uint32_t bin_count);

  void add(std::span<const Node> leaves, const BinGrid& grid);
  void add(const Bins& other);
  // The split of least SAH cost; none where one side of every split is empty. Of equal costs the first bin
  // wins, then the first axis.
  std::optional<BinSplit> best_split(float scale) const;

 private:
  using BoxOfAxis = std::array<LaneBox, AXES>;

  std::uint32_t bin_count_;
  std::array<BoxOfAxis, LIMIT> boxes_;  // by bin, then axis: a sweep goes through all axes at once
  std::array<Integers, LIMIT> counts_;  // an axis in each lane
};

}  // namespace coppice
