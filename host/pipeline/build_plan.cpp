#include <algorithm>
#include <stdexcept>
#include <string>

#include "interface/sort.h"
#include "pipeline/build.h"

namespace coppice {

namespace {

std::uint32_t divide_up(std::uint32_t a, std::uint32_t b) { return a / b + (a % b != 0); }

void add_ploc_slots(Layout& layout, BuildPlan& plan) {
  const std::uint32_t n = plan.triangle_count;
  plan.rounds_bound = ploc_rounds_bound(n, 1);
  plan.recorded_rounds = ploc_rounds_bound(n, PLOC_FINISH_CLUSTERS);
  plan.rounds = layout.add<PlocRound>("rounds", plan.rounds_bound + 1);
  plan.clusters[0] = layout.add<Node>("clusters_even", n);
  plan.clusters[1] = layout.add<Node>("clusters_odd", n);
  plan.partners = layout.add<uint>("partners", n);
  for (int i = 0; i < 2; ++i) {
    plan.round_status[i] = layout.add<uint>(i ? "round_status_odd" : "round_status_even",
                                            std::uint64_t{divide_up(n, PLOC_MERGE_TILE)} * PLOC_MERGE_SUMS);
  }
}

void add_hploc_slots(Layout& layout, BuildPlan& plan) {
  plan.clusters[0] = layout.add<Node>("clusters", plan.triangle_count);
  plan.cluster_names = layout.add<uint>("cluster_names", plan.triangle_count);
  plan.arrivals = layout.add<uint>("arrivals", plan.triangle_count);
}

void add_sort_status(Layout& layout, BuildPlan& plan) {
  const std::uint32_t passes = plan.options.morton_bits / 30 * SORT_PASSES_PER_WORD;
  plan.histogram = layout.add<uint>("histogram", passes * SORT_DIGITS);
  plan.sort_status = layout.add<uint>(
      "sort_status", std::uint64_t{passes} * divide_up(plan.triangle_count, SORT_TILE) * SORT_DIGITS);
  plan.sort_tickets = layout.add<uint>("sort_tickets", passes);
}

}  // namespace

BuildPlan plan_sort(Layout& layout, std::uint32_t key_count, const BuildOptions& options) {
  BuildPlan plan;
  plan.options = options;
  plan.triangle_count = key_count;
  plan.state = layout.add<BuildState>("state", 1);
  for (int i = 0; i < 2; ++i) {
    plan.keys[i] =
        layout.add<uint>(i ? "keys_b" : "keys_a", std::uint64_t{key_count} * options.morton_bits / 30);
    plan.values[i] = layout.add<uint>(i ? "values_b" : "values_a", key_count);
  }
  add_sort_status(layout, plan);
  return plan;
}

std::uint32_t ploc_rounds_bound(std::uint32_t clusters, std::uint32_t target) {
  if (clusters <= target) return 0;
  std::uint32_t epoch = 0;
  while (clusters >> epoch > target) ++epoch;
  return PLOC_EPOCH_ROUNDS * epoch + 2;
}

TreeSlots plan_tree(Layout& layout, std::uint32_t triangle_count, std::uint64_t node_count) {
  return {triangle_count, layout.add<Triangle>("triangles", triangle_count),
          layout.add<Node>("nodes", node_count), layout.add<BuildState>("state", 1)};
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
  plan.options = options;

  static_cast<TreeSlots&>(plan) = plan_tree(layout, n, n == 0 ? 0 : 2 * std::uint64_t{n} - 1);
  plan.boxes = layout.add<Aabb>("boxes", n);
  for (int i = 0; i < 2; ++i) {
    plan.keys[i] = layout.add<uint>(i ? "keys_b" : "keys_a", std::uint64_t{n} * key_words);
    plan.values[i] = layout.add<uint>(i ? "values_b" : "values_a", n);
  }
  add_sort_status(layout, plan);
  if (options.builder == DeviceBuilder::ploc)
    add_ploc_slots(layout, plan);
  else
    add_hploc_slots(layout, plan);
  return plan;
}

}  // namespace coppice
