#include "builders/morton_crowding.h"

#include <algorithm>
#include <array>
#include <vector>

#include "builders/lane_box.h"
#include "builders/lanes.h"
#include "builders/leaves.h"
#include "builders/morton_order.h"
#include "builders/normalised_space.h"
#include "builders/threads.h"

namespace coppice {
namespace {

constexpr std::size_t CROWDING_CHUNK = 1 << 13;

struct ActiveTriangles {
  Aabb box;
  std::size_t count = 0;
};

ActiveTriangles one_by_one(std::span<const Triangle> triangles) {
  ActiveTriangles active{bounds_of({})};
  for (const Triangle& triangle : triangles) {
    if (!is_active(triangle)) continue;
    active.box = box_union(active.box, triangle_box(triangle));
    ++active.count;
  }
  return active;
}

// Four triangles are nine vectors, and every third vector has its lanes on the same axes. This pass reads all
// triangles, so it decides what the choice costs.
ActiveTriangles active_triangles(std::span<const Triangle> triangles) {
  const std::size_t fours = triangles.size() / LANES;
  const auto* const coordinates = reinterpret_cast<const float*>(triangles.data());
  std::array<LaneBox, AXES> bounds;
  bounds.fill(EMPTY_LANE_BOX);
  Integers is_finite = Integers{} - 1;
  for (std::size_t i = 0; i < fours * 3; ++i) {
    for (std::size_t k = 0; k < AXES; ++k) {
      const Floats lanes = load(coordinates + (i * AXES + k) * LANES);
      bounds[k] = lane_union({lanes, lanes}, bounds[k]);
      is_finite &= lanes - lanes == 0.0f;
    }
  }
  if (!(is_finite[0] & is_finite[1] & is_finite[2] & is_finite[3])) return one_by_one(triangles);
  ActiveTriangles active = one_by_one(triangles.subspan(fours * LANES));
  active.count += fours * LANES;
  for (std::size_t lane = 0; fours > 0 && lane < AXES * LANES; ++lane) {
    const LaneBox& from = bounds[lane / LANES];
    float& low = active.box.box_min[static_cast<int>(lane % AXES)];
    float& high = active.box.box_max[static_cast<int>(lane % AXES)];
    low = std::min(low, from.low[lane % LANES]);
    high = std::max(high, from.high[lane % LANES]);
  }
  return active;
}

ActiveTriangles active_triangles(std::span<const Triangle> triangles, const Threads& threads) {
  std::vector<ActiveTriangles> parts(chunk_count(triangles.size(), CROWDING_CHUNK));
  threads.for_each_chunk(triangles.size(), CROWDING_CHUNK, [&](Chunk chunk, std::size_t k) {
    parts[k] = active_triangles(triangles.subspan(chunk.begin, chunk.count()));
  });
  ActiveTriangles all{bounds_of({})};
  for (const ActiveTriangles& part : parts) {
    all.box = box_union(all.box, part.box);
    all.count += part.count;
  }
  return all;
}

// The k-th number below `count`, which is at most 2^32, of a fixed sequence that looks random.
std::size_t drawn(std::uint64_t k, std::uint64_t count) {
  std::uint64_t x = (k + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 32) * 0xd6e8feb86659fd93u;
  return static_cast<std::size_t>((x >> 32) * count >> 32);
}

// Ordered pairs of different entries that agree in all but their lowest `ignored_bits` bits.
double equal_pairs(std::span<const std::uint64_t> codes, std::span<const std::uint32_t> order,
                   int ignored_bits) {
  double pairs = 0;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const std::uint64_t cell = codes[order[begin]] >> ignored_bits;
    while (end < order.size() && codes[order[end]] >> ignored_bits == cell) ++end;
    pairs += static_cast<double>(end - begin) * static_cast<double>(end - begin - 1);
  }
  return pairs;
}

}  // namespace

MortonCrowding morton_crowding(std::span<const Triangle> triangles) {
  const Threads threads(0);
  const ActiveTriangles active = active_triangles(triangles, threads);
  if (active.count < 2) return {};
  const NormalisedSpace to_normalised(active.box);
  const MortonGrid grid(to_normalised(active.box), 20);
  const bool all = triangles.size() <= CROWDING_SAMPLES;
  std::vector<std::uint64_t> codes;
  codes.reserve(CROWDING_SAMPLES);
  for (std::size_t k = 0; k < (all ? triangles.size() : CROWDING_SAMPLES); ++k) {
    const Triangle& triangle = triangles[all ? k : drawn(k, triangles.size())];
    if (is_active(triangle)) codes.push_back(grid.code_of(to_normalised(triangle_box(triangle))));
  }
  if (codes.size() < 2) return {};
  const std::vector<std::uint32_t> order = sorted_order(codes, 60, threads);
  const auto samples = static_cast<double>(codes.size()), count = static_cast<double>(active.count);
  // A pair of draws agrees if it drew one triangle twice, or two in one cell.
  const double others = all ? count - 1 : count, itself = all ? 0 : 1;
  const double scale = others / (samples * (samples - 1));
  // Both grids start at one corner, and their cells differ by a power of two: 30 bits are the upper half.
  return {equal_pairs(codes, order, 30) * scale - itself, equal_pairs(codes, order, 0) * scale - itself};
}

std::uint32_t choose_morton_bits(std::span<const Triangle> triangles) {
  const MortonCrowding crowding = morton_crowding(triangles);
  return crowding.with_30_bits - crowding.with_60_bits > CROWDING_LIMIT ? 60 : 30;
}

}  // namespace coppice
