#pragma once

#include "stages/run_counts.h"

namespace coppice::traffic {

// Of rays beside those of the camera, the part of a sum over all of them that a step has which could have one
// for each of `rays` rays of the picture.
inline std::uint64_t part_of(const RunCounts::Secondary& secondary, std::uint64_t sum, std::uint64_t rays) {
  if (secondary.could_be == 0) return 0;
  return static_cast<std::uint64_t>(static_cast<double>(sum) * static_cast<double>(rays) /
                                    static_cast<double>(secondary.could_be));
}

inline std::uint64_t shadow_share(std::uint64_t sum, std::uint64_t rays, const RunCounts& counts) {
  return part_of(counts.shadow, sum, rays);
}

}  // namespace coppice::traffic
