#include <algorithm>

#include "stages/divide_up.h"
#include "stages/stages.h"

// What the stages of builds, sorts and scans move at least: "cost" in docs/kernels.md.
namespace coppice::traffic {

namespace {

// None of nothing, whatever the size of a tile.
Bytes tiles(Bytes count, Bytes tile) { return count == 0 ? 0 : divide_up(count, tile); }

constexpr Bytes digit_row = SORT_DIGITS * sizeof(uint);  // of Onesweep: a word for each digit

// Of so many, as many as the device says, where it does.
Bytes counted(Address<const uint> count_at, Bytes most, const RunCounts& counts) {
  return count_at.value ? std::min<Bytes>(most, counts.primitive_count) : most;
}

template <class Args>
Bytes keys_of(const Args& a, const RunCounts& counts) {
  return counted(a.count_at, a.count, counts);
}

Bytes pairs_moved(Bytes count, Bytes key_words, bool has_values) {
  return count * 2 * (4 * key_words + (has_values ? 4 : 0));
}

// Words of all digits of all tiles, where Onesweep is not used.
Bytes tile_digits_bytes(const SortScatterArgs& args, Bytes count) {
  return tiles(count, args.tile_keys) * sizeof(uint) << args.digit_bits;
}

// A round without workgroups, which is the finish's, moves nothing in the stages of rounds.
PlocRound round_of(std::uint32_t index, const RunCounts& counts) {
  const bool dispatched = index < counts.rounds.size() && counts.rounds[index].merge_groups.x != 0;
  return dispatched ? counts.rounds[index] : PlocRound{};
}

Bytes level_of(std::uint32_t index, const RunCounts& counts) {
  return index < counts.wide_levels.size() ? Bytes{counts.wide_levels[index].count} : 0;
}

// New wide nodes. Together they open every internal binary node once, and read the two nodes below it.
Bytes collapse_bytes(Bytes nodes, const RunCounts& counts) {
  if (counts.wide_nodes == 0) return 0;
  const Bytes opened = (Bytes{counts.active_count} - 1) * nodes / counts.wide_nodes;
  return nodes * (WIDE_CHILDREN * 4 + sizeof(WideEntry)) + opened * 2 * sizeof(Node);
}

Bytes next_level_bytes(std::uint32_t level, const RunCounts& counts) {
  return level_of(level, counts) * (WIDE_CHILDREN * 4 + sizeof(WideEntry)) +
         collapse_bytes(level_of(level + 1, counts), counts);
}

Bytes sizes_bytes(std::uint32_t level, const RunCounts& counts) {
  return level_of(level, counts) * (sizeof(WideEntry) + 4) + level_of(level + 1, counts) * (4 + 4);
}

}  // namespace

// Three vertices by their indices, and the triangle.
Bytes gather_triangles(const GatherTrianglesArgs& a, const RunCounts& counts) {
  const Bytes vertices = 3 * (sizeof(vec3) + (a.indices.value ? a.index_bytes : 0));
  return counted(a.count_at, a.triangle_count, counts) * (vertices + sizeof(Triangle));
}

Bytes primitive_bounds(const PrimitiveBoundsArgs& a, const RunCounts& counts) {
  return counted(a.count_at, a.triangle_count, counts) * (sizeof(Triangle) + sizeof(Aabb));
}

Bytes box_bounds(const BoxBoundsArgs& a, const RunCounts& counts) {
  return counted(a.count_at, a.box_count, counts) * 2 * sizeof(Aabb);
}

Bytes morton_codes(const MortonCodesArgs& a, const RunCounts& counts) {
  return counted(a.count_at, a.triangle_count, counts) * (sizeof(Aabb) + 4 * a.key_words + 4);
}

Bytes sort_histogram(const SortHistogramArgs& a, const RunCounts& counts) {
  return keys_of(a, counts) * 4 * a.key_words;
}

Bytes sort_digit_scan(const SortDigitScanArgs& a, const RunCounts&) {
  return Bytes{a.pass_count} * 2 * digit_row;
}

// Status words are written as aggregate and as prefix, and read by the next tile.
Bytes sort_pass(const SortPassArgs& a, const RunCounts& counts) {
  const Bytes keys = keys_of(a, counts);
  return pairs_moved(keys, a.key_words, a.values_in.value != 0) + tiles(keys, a.tile_keys) * 3 * digit_row;
}

Bytes sort_tile_counts(const SortScatterArgs& a, const RunCounts& counts) {
  const Bytes keys = keys_of(a, counts);
  return keys * 4 + tile_digits_bytes(a, keys);
}

Bytes sort_tile_scan(const SortTileScanArgs& a, const RunCounts& counts) {
  return tiles(keys_of(a, counts), a.tile_keys) * 2 * sizeof(uint) << a.digit_bits;
}

// One tile reads no counts but counts by itself.
Bytes sort_scatter(const SortScatterArgs& a, const RunCounts& counts) {
  const Bytes keys = keys_of(a, counts), digits = tile_digits_bytes(a, keys);
  return pairs_moved(keys, a.key_words, a.values_in.value != 0) +
         (a.count <= a.tile_keys ? keys * 4 + digits : 2 * digits);
}

Bytes ploc_leaves(const PlocLeavesArgs&, const RunCounts& counts) {
  return Bytes{counts.active_count} * (4 + sizeof(Aabb) + sizeof(Node));
}

Bytes ploc_tile_counts(const PlocMergeArgs& a, const RunCounts& counts) {
  const PlocRound round = round_of(a.round, counts);
  const Bytes searched = round.pair_all ? 0 : round.cluster_count;
  return searched * sizeof(Node) + Bytes{round.cluster_count} * 4 + Bytes{round.merge_groups.x} * 8;
}

Bytes ploc_tile_scan(const PlocTileScanArgs& a, const RunCounts& counts) {
  return Bytes{round_of(a.round, counts).merge_groups.x} * 24;
}

Bytes ploc_merge(const PlocMergeArgs& a, const RunCounts& counts) {
  const PlocRound round = round_of(a.round, counts);
  if (round.cluster_count == 0) return 0;
  const Bytes merges = counts.rounds.at(a.round + 1).merged_before - round.merged_before;
  return Bytes{round.cluster_count} * (4 + 2 * sizeof(Node)) + merges * sizeof(Node);
}

Bytes ploc_finish(const PlocFinishArgs&, const RunCounts& counts) {
  const auto first =
      std::ranges::find(counts.rounds, 0u, [](const PlocRound& r) { return r.merge_groups.x; });
  if (first == counts.rounds.end() || first->cluster_count == 0) return 0;
  const Bytes clusters = first->cluster_count;
  return clusters * sizeof(Node) + (2 * clusters - 1) * sizeof(Node);
}

// A leaf is read in sorted order, and all nodes are written once; what tiles hand over is little beside it.
Bytes hploc_build(const HplocBuildArgs& a, const RunCounts& counts) {
  return Bytes{counts.active_count} * (4 + 4 * a.key_words + sizeof(Aabb) + 2 * sizeof(Node));
}

// As if every primitive were an active one of a tree. Codes, clusters and partners stay in shared memory.
Bytes batch_build(const BatchBuildArgs& a, const RunCounts&) {
  return Bytes{a.range_count} * (sizeof(BatchRange) + sizeof(BatchTree)) +
         Bytes{a.primitive_count} * (sizeof(Aabb) + 2 * sizeof(Node));
}

Bytes wide_root(const WideCollapseArgs&, const RunCounts& counts) {
  return collapse_bytes(level_of(0, counts), counts);
}

Bytes wide_collapse(const WideCollapseArgs& a, const RunCounts& counts) {
  return next_level_bytes(a.level, counts);
}

Bytes wide_collapse_rest(const WideCollapseRestArgs& a, const RunCounts& counts) {
  Bytes bytes = 0;
  for (std::uint32_t level = a.level; level < a.level_limit; ++level)
    bytes += next_level_bytes(level, counts);
  return bytes;
}

Bytes wide_sizes(const WideSizesArgs& a, const RunCounts& counts) { return sizes_bytes(a.level, counts); }

Bytes wide_sizes_rest(const WideSizesRestArgs& a, const RunCounts& counts) {
  Bytes bytes = 0;
  for (std::uint32_t level = a.level; level < a.level_limit; ++level) bytes += sizes_bytes(level, counts);
  return bytes;
}

Bytes wide_quantise(const WideQuantiseArgs&, const RunCounts& counts) {
  const Bytes nodes = counts.wide_nodes;
  if (nodes == 0) return 0;
  const Bytes children = counts.active_count + nodes - 1;  // each leaf and each wide node but the root is one
  return nodes * (sizeof(WideEntry) + 4 + WIDE_CHILDREN * 4 + sizeof(WideNode)) +
         (children + nodes) * sizeof(Node);
}

Bytes copy_words(const CopyWordsArgs& a, const RunCounts&) { return Bytes{a.quad_count} * 2 * sizeof(uvec4); }

Bytes scan_tile_sums(const ScanTileSumsArgs& a, const RunCounts& counts) {
  const Bytes words = counted(a.count_at, a.word_count, counts);
  return words * 4 + tiles(words, SCAN_TILE * 4) * 4;
}

// As for a sort's pass; without lookback a word a tile is read.
Bytes prefix_scan(const PrefixScanArgs& a, const RunCounts& counts) {
  const Bytes words = counted(a.count_at, a.word_count, counts);
  return words * 2 * 4 + tiles(words, SCAN_TILE * 4) * 4 * (a.lookback ? 3 * SCAN_SUMS : 1);
}

}  // namespace coppice::traffic
