#include "measure/stability_runs.h"

#include <algorithm>
#include <cstring>

#include "analysis/hard_rays.h"
#include "analysis/validate.h"
#include "builders/ploc.h"
#include "measure/progress.h"
#include "pipeline/ray_tracing.h"
#include "render/scene_arrays.h"
#include "stages/errors.h"
#include "stages/lockstep_executor.h"

namespace coppice {

namespace {

constexpr std::string_view inside = "from inside", bounced = "bounced";

struct RayBatch {
  std::string_view kind;
  std::size_t first, count;
};

struct BatchedRays {
  std::vector<Ray> rays;
  std::vector<RayBatch> batches;

  void add(std::string_view kind, const std::vector<Ray>& more) {
    batches.push_back({kind, rays.size(), more.size()});
    rays.insert(rays.end(), more.begin(), more.end());
  }
};

void build_in_lockstep(CheckedDevice& device, std::span<const Triangle> triangles,
                       const BuilderChoice& builder, StabilityCase& result, std::vector<Node>& nodes) {
  Layout layout(device.properties().max_block_bytes);
  const BuildPlan plan = plan_build(layout, static_cast<std::uint32_t>(triangles.size()),
                                    device.build_options(builder.build_options(triangles)));
  LockstepExecutor executor(device.device(), layout);
  executor.upload(plan.triangles, triangles);
  if (const auto difference = executor.run([&](Chain& chain) { append_build(chain, plan); })) {
    result.difference = difference->stage + ", " + difference->slot;
  }
  const BuildState state = executor.gpu().read(plan.state)[0];
  result.rounds = state.round_count;
  result.rounds_bound = plan.rounds_bound;
  const std::uint64_t node_count = state.active_count == 0 ? 0 : 2 * std::uint64_t{state.active_count} - 1;
  nodes = executor.gpu().read(Slot<Node>{plan.nodes.place, node_count});
  result.depth = nodes.empty() ? 0 : nodes[0].height;
  result.fault = find_fault(nodes, triangles).value_or("");
  const Bvh independent = build_ploc(triangles, {plan.options.radius, plan.options.morton_bits});
  result.same_as_builder = std::ranges::equal(nodes, independent.nodes, [](const Node& a, const Node& b) {
    return std::memcmp(&a, &b, sizeof(Node)) == 0;
  });
}

VariantResult trace_variant(RayTracing& tracing, const IntersectionVariant& variant, TraceOptions options,
                            const BatchedRays& batched, std::span<const Node> nodes,
                            std::span<const Triangle> triangles) {
  options.triangle_test = variant.triangle_test;
  options.box_test = variant.box_test;
  VariantResult result{&variant, {}, false, ""};
  const TracedRays traced = tracing.on_device(batched.rays, options);
  result.error = describe_error_word(traced.error_word);
  if (!result.error.empty()) return result;
  const TracedRays twins = tracing.by_twins(batched.rays, options);
  result.bits_equal =
      std::memcmp(traced.hits.data(), twins.hits.data(), twins.hits.size() * sizeof(Hit)) == 0;
  for (const RayBatch& batch : batched.batches) {
    const auto rays = std::span(batched.rays).subspan(batch.first, batch.count);
    const auto hits = std::span(traced.hits).subspan(batch.first, batch.count);
    const TracedBatch judged{nodes, triangles, rays, hits};
    RayResult kind{batch.kind, judge_hits(nodes, triangles, rays, hits)};
    if (batch.kind == inside) kind.leaks = kind.verdicts.rays - kind.verdicts.hits;
    const auto by_twins = std::span(twins.hits).subspan(batch.first, batch.count);
    kind.examples = examples_of(judged, kind.verdicts, by_twins, batch.kind, batch.kind == inside);
    result.kinds.push_back(kind);
  }
  return result;
}

}  // namespace

std::vector<Triangle> case_triangles(const HardCase& hard_case, std::uint32_t count, std::uint64_t seed,
                                     float scale) {
  Scene scene = hard_case.make(count, seed);
  for (vec3& position : scene.positions) position *= scale;
  bring_into_range(scene);
  return scene_arrays(scene).triangles;
}

vec3 centre_of(const Node& node) { return node.box_min * 0.5f + node.box_max * 0.5f; }

StabilityCase examine_case(CheckedDevice& device, const HardCase& hard_case,
                           const StabilityOptions& options) {
  const std::uint32_t asked = std::min(hard_case.default_triangle_count, options.most_triangles);
  const std::vector<Triangle> triangles = case_triangles(hard_case, asked, options.seed);
  StabilityCase result;
  result.scene = hard_case.name;
  result.seed = options.seed;
  result.triangles = triangles.size();
  std::vector<Node> nodes;
  build_in_lockstep(device, triangles, options.builder, result, nodes);

  BatchedRays batched;
  for (const RayKindName& kind : ray_kinds()) {
    batched.add(kind.name, hard_rays(kind.kind, triangles, nodes, options.rays, options.seed));
  }
  if (hard_case.closed) {
    batched.add(inside, inside_rays(centre_of(nodes[0]), triangles, options.rays, options.seed));
  }
  const std::vector<Ray> first = hard_rays(RayKind::RANDOM, triangles, nodes, options.rays, options.seed);
  RayTracing tracing(device.device(), nodes, triangles,
                     static_cast<std::uint32_t>(batched.rays.size() + first.size()));
  const TraceOptions trace_options = device.trace_options({});
  batched.add(bounced, tracing.bounce(first, trace_options, 1));
  for (const IntersectionVariant& variant : intersection_variants()) {
    result.variants.push_back(trace_variant(tracing, variant, trace_options, batched, nodes, triangles));
  }
  return result;
}

ExaminedCases examine_cases(CheckedDevice& device, std::span<const HardCase* const> chosen,
                            const StabilityOptions& options) {
  ExaminedCases cases;
  StabilityOptions one = options;
  Progress progress("hard cases", static_cast<std::uint32_t>(chosen.size()) * options.seed_count);
  for (std::uint32_t seed = 0; seed < options.seed_count; ++seed, ++one.seed) {
    for (const HardCase* const hard_case : chosen) {
      const StabilityCase result = examine_case(device, *hard_case, one);
      ++cases.examined;
      cases.failed += !result.passes();
      cases.kinds.add(result);
      if (options.seed_count == 1 || !result.passes()) cases.rows.push_back(result);
      progress.step();
    }
  }
  return cases;
}

}  // namespace coppice
