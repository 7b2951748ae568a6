#include "measure/traffic.h"

#include <algorithm>

#include "pipeline/trace.h"
#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

using Bytes = std::uint64_t;

// None of nothing, whatever the size of a tile.
Bytes tiles(Bytes count, Bytes tile) { return count == 0 ? 0 : divide_up(count, tile); }

constexpr Bytes digit_row = SORT_DIGITS * sizeof(uint);  // of Onesweep: a word for each digit

// Of so many, as many as the device says, where it does.
Bytes counted(UintBuffer count_at, Bytes most, const RunCounts& counts) {
  return count_at.value ? std::min<Bytes>(most, counts.primitive_count) : most;
}

Bytes pairs_moved(Bytes count, Bytes key_words, bool has_values) {
  return count * 2 * (4 * key_words + (has_values ? 4 : 0));
}

Bytes prefix_scan_bytes(const PrefixScanArgs& args, Bytes words) {
  // As for a sort's pass; without lookback a word a tile is read.
  const Bytes status = tiles(words, SCAN_TILE * 4) * 4 * (args.lookback ? 3 * SCAN_SUMS : 1);
  return words * 2 * 4 + status;
}

std::optional<Bytes> scan_bytes(const Step& step, const RunCounts& counts) {
  const auto words = [&](const auto& args) { return counted(args.count_at, args.word_count, counts); };
  if (const auto* a = args_of(step, stages::scan_tile_sums))
    return words(*a) * 4 + tiles(words(*a), SCAN_TILE * 4) * 4;
  if (const auto* a = args_of(step, stages::prefix_scan)) return prefix_scan_bytes(*a, words(*a));
  return std::nullopt;
}

std::optional<Bytes> primitive_bytes(const Step& step, const RunCounts& counts) {
  const auto primitives = [&](const auto& args) {
    return counted(args.count_at, args.triangle_count, counts);
  };
  // Three vertices by their indices, and the triangle.
  if (const auto* a = args_of(step, stages::gather_triangles))
    return primitives(*a) * (3 * (sizeof(vec3) + (a->indices.value ? a->index_bytes : 0)) + sizeof(Triangle));
  if (const auto* a = args_of(step, stages::box_bounds))
    return counted(a->count_at, a->box_count, counts) * 2 * sizeof(Aabb);
  if (const auto* a = args_of(step, stages::primitive_bounds))
    return primitives(*a) * (sizeof(Triangle) + sizeof(Aabb));
  if (const auto* a = args_of(step, stages::morton_codes))
    return primitives(*a) * (sizeof(Aabb) + 4 * a->key_words + 4);
  return std::nullopt;
}

// Words of all digits of all tiles, where Onesweep is not used.
Bytes tile_digits_bytes(const SortScatterArgs& args, Bytes count) {
  return tiles(count, args.tile_keys) * sizeof(uint) << args.digit_bits;
}

std::optional<Bytes> sort_bytes(const Step& step, const RunCounts& counts) {
  const auto keys = [&](const auto& args) { return counted(args.count_at, args.count, counts); };
  if (const auto* a = args_of(step, stages::sort_histogram)) return keys(*a) * 4 * a->key_words;
  if (const auto* a = args_of(step, stages::sort_digit_scan)) return Bytes{a->pass_count} * 2 * digit_row;
  // Status words are written as aggregate and as prefix, and read by the next tile.
  if (const auto* a = args_of(step, stages::sort_pass))
    return pairs_moved(keys(*a), a->key_words, a->values_in.value != 0) +
           tiles(keys(*a), a->tile_keys) * 3 * digit_row;
  if (const auto* a = args_of(step, stages::sort_tile_counts))
    return keys(*a) * 4 + tile_digits_bytes(*a, keys(*a));
  if (const auto* a = args_of(step, stages::sort_tile_scan))
    return tiles(keys(*a), a->tile_keys) * 2 * sizeof(uint) << a->digit_bits;
  if (const auto* a = args_of(step, stages::sort_scatter)) {
    const Bytes pairs = pairs_moved(keys(*a), a->key_words, a->values_in.value != 0);
    const Bytes digits = tile_digits_bytes(*a, keys(*a));
    // One tile reads no counts but counts by itself.
    return pairs + (a->count <= a->tile_keys ? keys(*a) * 4 + digits : 2 * digits);
  }
  return std::nullopt;
}

Bytes merge_bytes(const PlocRound& round, const PlocRound& next) {
  const Bytes merges = next.merged_before - round.merged_before;
  return Bytes{round.cluster_count} * (4 + 2 * sizeof(Node)) + merges * sizeof(Node);
}

Bytes tile_counts_bytes(const PlocRound& round) {
  const Bytes searched = round.pair_all ? 0 : round.cluster_count;
  return searched * sizeof(Node) + Bytes{round.cluster_count} * 4 + Bytes{round.merge_groups.x} * 8;
}

Bytes finish_bytes(const RunCounts& counts) {
  const auto first =
      std::ranges::find(counts.rounds, 0u, [](const PlocRound& r) { return r.merge_groups.x; });
  if (first == counts.rounds.end() || first->cluster_count == 0) return 0;
  const Bytes clusters = first->cluster_count;
  return clusters * sizeof(Node) + (2 * clusters - 1) * sizeof(Node);
}

// As if every primitive were an active one of a tree. Codes, clusters and partners stay in shared memory.
std::optional<Bytes> batch_bytes(const Step& step) {
  const auto* const a = args_of(step, stages::batch_build);
  if (!a) return std::nullopt;
  return Bytes{a->range_count} * (sizeof(BatchRange) + sizeof(BatchTree)) +
         Bytes{a->primitive_count} * (sizeof(Aabb) + 2 * sizeof(Node));
}

std::optional<Bytes> ploc_bytes(const Step& step, const RunCounts& counts) {
  // A round without workgroups, which is the finish's, moves nothing in these stages.
  const auto round = [&](std::uint32_t index) {
    const bool dispatched = index < counts.rounds.size() && counts.rounds[index].merge_groups.x != 0;
    return dispatched ? counts.rounds[index] : PlocRound{};
  };
  if (stage_of(step) == &stages::ploc_leaves)
    return Bytes{counts.active_count} * (4 + sizeof(Aabb) + sizeof(Node));
  if (const auto* a = args_of(step, stages::ploc_merge)) {
    const PlocRound merged = round(a->round);
    return merged.cluster_count == 0 ? 0 : merge_bytes(merged, counts.rounds.at(a->round + 1));
  }
  if (const auto* a = args_of(step, stages::ploc_tile_counts)) return tile_counts_bytes(round(a->round));
  if (const auto* a = args_of(step, stages::ploc_tile_scan))
    return Bytes{round(a->round).merge_groups.x} * 24;
  if (stage_of(step) == &stages::ploc_finish) return finish_bytes(counts);
  // A leaf is read in sorted order, and all nodes are written once; what tiles hand over is little beside it.
  if (const auto* a = args_of(step, stages::hploc_build))
    return Bytes{counts.active_count} * (4 + 4 * a->key_words + sizeof(Aabb) + 2 * sizeof(Node));
  return batch_bytes(step);
}

// New wide nodes. Together they open every internal binary node once, and read the two nodes below it.
Bytes collapse_bytes(Bytes nodes, const RunCounts& counts) {
  if (counts.wide_nodes == 0) return 0;
  const Bytes opened = (Bytes{counts.active_count} - 1) * nodes / counts.wide_nodes;
  return nodes * (WIDE_CHILDREN * 4 + sizeof(WideEntry)) + opened * 2 * sizeof(Node);
}

std::optional<Bytes> wide_bytes(const Step& step, const RunCounts& counts) {
  const Bytes nodes = counts.wide_nodes;
  const auto level = [&](std::uint32_t index) {
    return index < counts.wide_levels.size() ? Bytes{counts.wide_levels[index].count} : 0;
  };
  if (stage_of(step) == &stages::wide_root) return collapse_bytes(level(0), counts);
  if (const auto* a = args_of(step, stages::wide_collapse))
    return level(a->level) * (WIDE_CHILDREN * 4 + sizeof(WideEntry)) +
           collapse_bytes(level(a->level + 1), counts);
  if (const auto* a = args_of(step, stages::wide_sizes))
    return level(a->level) * (sizeof(WideEntry) + 4) + level(a->level + 1) * (4 + 4);
  if (stage_of(step) == &stages::wide_quantise) {
    if (nodes == 0) return 0;
    const Bytes children =
        counts.active_count + nodes - 1;  // each leaf and each wide node but the root is one
    return nodes * (sizeof(WideEntry) + 4 + WIDE_CHILDREN * 4 + sizeof(WideNode)) +
           (children + nodes) * sizeof(Node);
  }
  return std::nullopt;
}

// Of a sum over the whole trace, the part that `rays` of its rays have.
Bytes share(Bytes sum, Bytes rays, const RunCounts& counts) {
  if (counts.rays == 0) return 0;
  return static_cast<Bytes>(static_cast<double>(sum) * static_cast<double>(rays) /
                            static_cast<double>(counts.rays));
}

Bytes shade_bytes(const ShadeArgs& args, const RunCounts& counts) {
  const Bytes hits = share(counts.hits, args.ray_count, counts);
  const Bytes radiance = sizeof(vec3) * (args.sample_index == 0 ? 1 : 2);
  return args.ray_count * (sizeof(Ray) + 4 + radiance) +
         hits * (4 + sizeof(SurfaceMaterial) + sizeof(Triangle));
}

constexpr Bytes ray_and_hit = sizeof(Ray) + 2 * sizeof(Hit);  // the hit is read and written
constexpr Bytes ray_and_word = sizeof(Ray) + sizeof(uint);

// Of a walk that visits so much over the whole trace.
template <class Args>
Bytes walk_bytes(const Args& args, Bytes per_ray, Bytes visited, const RunCounts& counts) {
  const Bytes rays = args.count_at.value ? std::min<Bytes>(args.ray_count, counts.rays) : args.ray_count;
  return rays * per_ray + share(visited, rays, counts);
}

std::optional<Bytes> walk_bytes(const Step& step, const RunCounts& counts) {
  const Bytes pairs = counts.steps * 2 * sizeof(Node), nodes = counts.steps * sizeof(WideNode);
  const Bytes triangles = counts.hits * sizeof(Triangle);
  if (const auto* a = args_of(step, stages::trace_closest))
    return walk_bytes(*a, ray_and_hit, pairs + triangles, counts);
  if (const auto* a = args_of(step, stages::trace_wide))
    return walk_bytes(*a, ray_and_hit, counts.steps / TRACE_PACKET * sizeof(WideNode) + triangles, counts);
  if (const auto* a = args_of(step, stages::trace_wide_single))
    return walk_bytes(*a, ray_and_hit, nodes + triangles, counts);
  if (const auto* a = args_of(step, stages::trace_misses))
    return walk_bytes(*a, sizeof(Ray) + sizeof(Hit), 0, counts);
  if (const auto* a = args_of(step, stages::trace_any))
    return walk_bytes(*a, ray_and_word, pairs + triangles, counts);
  if (const auto* a = args_of(step, stages::trace_wide_any))
    return walk_bytes(*a, ray_and_word, nodes + triangles, counts);
  // Of each ray with candidates at least one is written.
  if (const auto* a = args_of(step, stages::trace_candidates))
    return walk_bytes(*a, ray_and_word, pairs + counts.hits * sizeof(BoxCandidate), counts);
  return std::nullopt;
}

std::optional<Bytes> trace_bytes(const Step& step, const RunCounts& counts) {
  if (const auto* a = args_of(step, stages::camera_rays))
    return Bytes{a->ray_count} * (sizeof(Ray) + sizeof(Hit));
  if (const auto* a = args_of(step, stages::trace_brute_force))
    return a->ray_count * ray_and_hit + a->triangle_count * sizeof(Triangle);
  if (const auto* a = args_of(step, stages::bounce_rays))
    return a->ray_count * (2 * (sizeof(Ray) + sizeof(Hit))) +
           share(counts.hits, a->ray_count, counts) * sizeof(Triangle);
  if (const auto* a = args_of(step, stages::shade)) return shade_bytes(*a, counts);
  if (const auto* a = args_of(step, stages::resolve)) return Bytes{a->ray_count} * (sizeof(vec3) + 4);
  return walk_bytes(step, counts);
}

}  // namespace

RunCounts counts_of_trace(const TraceCounters& counters) {
  const TraceCounts traced = counts_of(counters);
  RunCounts counts;
  counts.rays = traced.rays;
  counts.hits = traced.hits;
  counts.steps = traced.steps;
  return counts;
}

std::optional<std::uint64_t> modelled_bytes(const Step& step, const RunCounts& counts) {
  if (const Clear* const clear = std::get_if<Clear>(&step)) return clear->bytes;
  if (std::holds_alternative<Mark>(step)) return 0;
  if (const auto* a = args_of(step, stages::copy_words)) return Bytes{a->quad_count} * 2 * sizeof(uvec4);
  std::optional<Bytes> bytes = scan_bytes(step, counts);
  if (!bytes) bytes = primitive_bytes(step, counts);
  if (!bytes) bytes = sort_bytes(step, counts);
  if (!bytes) bytes = ploc_bytes(step, counts);
  if (!bytes) bytes = wide_bytes(step, counts);
  if (!bytes) bytes = trace_bytes(step, counts);
  return bytes;
}

}  // namespace coppice
