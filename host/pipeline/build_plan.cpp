#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "interface/sort.h"
#include "pipeline/build.h"

namespace coppice {

namespace {

std::uint32_t divide_up(std::uint32_t a, std::uint32_t b) { return a / b + (a % b != 0); }

std::uint32_t worst_rounds(std::uint32_t clusters, std::uint32_t target,
                           std::map<std::uint32_t, std::uint32_t>& known) {
  if (clusters <= target || clusters <= 1) return 0;
  if (const auto found = known.find(clusters); found != known.end()) return found->second;
  // Either the round merges its share, or it merges at least one pair and the next one pairs all that are
  // left.
  const std::uint32_t after_share = clusters - divide_up(clusters, PLOC_SLOW_ROUND);
  const std::uint32_t after_pairing = divide_up(clusters - 1, 2);
  const std::uint32_t rounds =
      std::max(1 + worst_rounds(after_share, target, known), 2 + worst_rounds(after_pairing, target, known));
  return known[clusters] = rounds;
}

}  // namespace

std::uint32_t ploc_rounds_bound(std::uint32_t clusters, std::uint32_t target) {
  std::map<std::uint32_t, std::uint32_t> known;
  return worst_rounds(clusters, target, known);
}

BuildPlan plan_build(Layout& layout, std::uint32_t triangle_count, const BuildOptions& options) {
  if (options.radius < 1 || options.radius > PLOC_MAX_RADIUS) {
    throw std::invalid_argument("radius " + std::to_string(options.radius) + " is not in 1 to " +
                                std::to_string(PLOC_MAX_RADIUS));
  }
  if (options.morton_bits != 30 && options.morton_bits != 60) {
    throw std::invalid_argument("Morton codes have 30 or 60 bits, not " +
                                std::to_string(options.morton_bits));
  }
  if (triangle_count > max_triangles) {
    throw std::invalid_argument(std::to_string(triangle_count) + " triangles are more than a build takes, " +
                                std::to_string(max_triangles));
  }
  BuildPlan plan;
  const std::uint32_t n = triangle_count;
  const std::uint32_t key_words = options.morton_bits / 30;
  const std::uint32_t passes = key_words * SORT_PASSES_PER_WORD;
  plan.triangle_count = n;
  plan.options = options;
  plan.rounds_bound = ploc_rounds_bound(n, 1);
  plan.recorded_rounds = ploc_rounds_bound(n, PLOC_FINISH_CLUSTERS);

  plan.triangles = layout.add<Triangle>("triangles", n);
  plan.nodes = layout.add<Node>("nodes", n == 0 ? 0 : 2 * std::uint64_t{n} - 1);
  plan.state = layout.add<BuildState>("state", 1);
  plan.rounds = layout.add<PlocRound>("rounds", plan.rounds_bound + 1);
  plan.boxes = layout.add<Aabb>("boxes", n);
  for (int i = 0; i < 2; ++i) {
    plan.keys[i] = layout.add<uint>(i ? "keys_b" : "keys_a", std::uint64_t{n} * key_words);
    plan.values[i] = layout.add<uint>(i ? "values_b" : "values_a", n);
    plan.clusters[i] = layout.add<Node>(i ? "clusters_odd" : "clusters_even", n);
  }
  plan.histogram = layout.add<uint>("histogram", passes * SORT_DIGITS);
  plan.sort_status =
      layout.add<uint>("sort_status", std::uint64_t{passes} * divide_up(n, SORT_TILE) * SORT_DIGITS);
  plan.sort_tickets = layout.add<uint>("sort_tickets", passes);
  plan.nearest = layout.add<uint>("nearest", n);
  plan.round_status =
      layout.add<uint>("round_status", std::uint64_t{divide_up(n, PLOC_MERGE_TILE)} * PLOC_MERGE_SUMS);
  return plan;
}

}  // namespace coppice
