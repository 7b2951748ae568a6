#include "pipeline/check_chain.h"

#include <algorithm>
#include <limits>

#include "pipeline/batch.h"
#include "pipeline/check_inputs.h"
#include "pipeline/check_moving.h"
#include "pipeline/refit.h"
#include "pipeline/scan_plan.h"
#include "pipeline/trace_any.h"
#include "pipeline/wide_plan.h"
#include "stages/nearly.h"

namespace coppice {

namespace {

// Several tiles of every stage, and little work.
constexpr std::uint32_t check_triangles = 26000;
constexpr std::uint32_t brute_force_rays = 64;
constexpr std::uint32_t check_words = 3 * SCAN_TILE * 4 + 5;
constexpr std::uint32_t batch_trees = 50;
constexpr std::uint32_t chain_leaves = WIDE_MAX_HEIGHT + 1;
static_assert(chain_leaves / WIDE_CHILDREN >= WIDE_DISPATCHED_LEVELS);
constexpr double check_limit_seconds = 60;

constexpr const char* wrong_tree = "computes a wrong tree";
constexpr const char* wrong_refit = "refits a tree wrong";
constexpr const char* wrong_hits = "finds wrong hits";

class Check {
 public:
  Check(const DeviceProperties& device, const DeviceUse& use, bool lookback)
      : use_(use), options_(use.build), max_turns_(device.max_turns()), chain_(device.max_block_bytes) {
    options_.lookback = lookback;
    if (use.builds || use.wide || !use.traces.empty()) add_tree();
    for (const TraceOptions& trace : use.traces) add_trace(trace);
    chain_.compare(tree_.state, "leaves another error word");
    if (use.inputs) add_inputs();
    if (use.vertices) add_vertex_check(chain_);
    if (use.instances) add_instance_check(chain_, options_, max_turns_);
    if (use.batches) add_batch();
    if (use.sorts) add_sort();
    if (use.scans) add_scan();
    if (use.refits) add_refit();  // last, as what others have goes wrong here, too
  }

  CheckChain chain() && { return std::move(chain_); }

 private:
  Layout& layout() { return chain_.layout(); }

  void add_tree() {
    const BuildPlan build = plan_build(layout(), check_triangles, options_);
    chain_.upload(build.triangles, std::span<const Triangle>(triangles_));
    const auto steps = [build](Chain& chain) { append_build(chain, build); };
    if (use_.builds) {
      chain_.append(steps);
    } else {
      chain_.append_by_twins(steps);
      chain_.hand_over(build.nodes);
      chain_.hand_over(build.state);
    }
    chain_.compare(build.nodes, wrong_tree);
    tree_ = build;
    if (!use_.wide && !std::ranges::any_of(use_.traces, is_wide, &TraceOptions::walk)) return;
    add_wide(tree_, plan_wide(layout(), tree_, &build, max_turns_));
    add_deep_wide();
  }

  void add_wide(const TreeSlots& tree, const WidePlan& wide) {
    chain_.append([=](Chain& chain) { append_wide(chain, tree, wide); });
    chain_.compare(tree.wide_nodes, wrong_tree);
    chain_.compare(tree.wide_counts, wrong_tree);
  }

  // Of more levels than have dispatches of their own.
  void add_deep_wide() {
    const std::vector<Node> nodes = chain_of_boxes(chain_leaves);
    BuildState state{};
    state.active_count = chain_leaves;
    TreeSlots tree = plan_tree(layout(), chain_leaves, nodes.size());
    const WidePlan wide = plan_wide(layout(), tree, nullptr, max_turns_);
    chain_.upload(tree.nodes, std::span(nodes));
    chain_.upload(tree.state, std::span<const BuildState>(&state, 1));
    add_wide(tree, wide);
  }

  // A tree of its own, without some of the triangles, all of which then take another one's place, so that
  // some appear.
  void add_refit() {
    std::vector<Triangle> triangles = triangles_, moved = triangles_;
    std::ranges::reverse(moved);
    for (std::size_t i = 0; i < triangles.size(); i += 7) {
      triangles[i].a.x = std::numeric_limits<float>::infinity();
      moved[i / 2].b.y = std::numeric_limits<float>::infinity();
    }
    const Slot<Triangle> vertices = chain_.add("moved", moved);
    BuildPlan build = plan_build(layout(), check_triangles, options_);
    chain_.upload(build.triangles, std::span<const Triangle>(triangles));
    std::optional<WidePlan> wide;
    if (use_.wide) wide = plan_wide(layout(), build, &build, max_turns_);
    const RefitPlan refit = plan_refit(layout(), build, &build, max_turns_);
    chain_.append([=](Chain& chain) {
      append_build(chain, build);
      if (wide) append_wide(chain, build, *wide);
      append_refit_order(chain, build, refit);
      append_triangles(chain, build.triangles,
                       {.vertices = {chain.at(vertices).value}, .vertex_count = 3 * check_triangles});
      append_refit(chain, build, refit);
      if (wide) append_wide_boxes(chain, build, *wide);
      append_tree_cost(chain, build, refit);
    });
    chain_.compare(build.nodes, wrong_refit);
    chain_.compare(build.wide_nodes, wrong_refit);
    chain_.compare(refit.state, wrong_refit);
  }

  void add_trace(const TraceOptions& options) {
    const std::vector<Ray> rays = check_rays();
    const auto count =
        static_cast<std::uint32_t>(options.walk == Walk::brute_force ? brute_force_rays : rays.size());
    const Slot<Ray> ray_slot = chain_.add("rays", rays);
    add_rays(options, ray_slot, count, {});
    if (!use_.every_ray) return;
    const RayFilter filter{chain_.add("primitive_flags", random_words(check_triangles)),
                           chain_.add("ray_masks", random_words(rays.size())),
                           {}};
    add_rays(options, ray_slot, count, filter);
  }

  void add_rays(const TraceOptions& options, const Slot<Ray>& rays, std::uint32_t count,
                const RayFilter& filter) {
    const auto counters = layout().add<TraceCounters>("counters", 1);
    const RaySlots closest{rays, layout().add<Hit>("hits", rays.count), counters, filter};
    chain_.append([=, tree = tree_](Chain& chain) {
      append_misses(chain, closest, count);
      append_closest_hits(chain, tree, closest, count, options);
    });
    chain_.compare(closest.hits, wrong_hits, Nearly::hits);
    if (!use_.every_ray) return;
    const AnyHitSlots any{rays, layout().add<uint>("any_hits", rays.count), counters, filter};
    chain_.append([=, tree = tree_](Chain& chain) { append_any_hits(chain, tree, any, count, options); });
    chain_.compare(any.any_hits, wrong_hits, Nearly::any_hits);
    if (is_wide(options.walk)) return;
    const CandidateSlots boxes{2,
                               rays,
                               layout().add<BoxCandidate>("candidates", 2 * rays.count),
                               layout().add<uint>("candidate_counts", rays.count),
                               counters,
                               filter};
    chain_.append([=, tree = tree_](Chain& chain) { append_candidates(chain, tree, boxes, count, options); });
    chain_.compare(boxes.candidates, wrong_hits, Nearly::candidates);
    chain_.compare(boxes.candidate_counts, wrong_hits, Nearly::candidate_counts);
  }

  // Triangles by an index buffer, moved, and boxes.
  void add_inputs() {
    std::vector<uint> indices(3 * check_triangles);
    for (uint i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint>(indices.size()) - 1 - i;
    const std::vector<float> transform = {0.5f, 0, 0.25f, 1, 0, 2, 0, -1, 1, 0, 0.125f, 0};
    const Slot<Triangle> vertices = chain_.add("vertices", triangles_);
    const Slot<uint> index_slot = chain_.add("indices", indices);
    const Slot<float> transform_slot = chain_.add("transform", transform);
    const PrimitiveSlots gathered = plan_primitives(layout(), check_triangles, PrimitiveKind::triangles);
    const PrimitiveSlots boxes = plan_primitives(layout(), check_triangles, PrimitiveKind::boxes);
    chain_.append([=](Chain& chain) {
      VertexTriangles input;
      input.vertices = {chain.at(vertices).value};
      input.indices = chain.at(index_slot);
      input.transform = {chain.at(transform_slot).value};
      input.vertex_count = 3 * check_triangles;
      append_primitives(chain, gathered, {input, {}});
      // Any nine floats are a box and a half.
      append_primitives(chain, boxes, {GivenBoxes{{chain.at(vertices).value}, sizeof(Triangle)}, {}});
    });
    chain_.compare(gathered.triangles, wrong_tree);
    for (const PrimitiveSlots& slots : {gathered, boxes}) {
      chain_.compare(slots.boxes, wrong_tree);
      chain_.compare(slots.state, wrong_tree);
    }
  }

  // Trees of no primitive, of one, and so on.
  void add_batch() {
    std::vector<BatchRange> ranges;
    uint first = 0;
    for (uint i = 0; i < batch_trees; ++i) {
      ranges.push_back({first, i * i % BATCH_MAX_PRIMITIVES});
      first += ranges.back().count;
    }
    const BatchPlan batch = plan_batch(layout(), check_triangles, batch_trees, options_);
    chain_.upload(batch.primitives.triangles, std::span<const Triangle>(triangles_));
    chain_.upload(batch.ranges, std::span<const BatchRange>(ranges));
    chain_.append([=](Chain& chain) { append_batch(chain, batch); });
    chain_.compare(batch.nodes, wrong_tree);
    chain_.compare(batch.trees, wrong_tree);
    chain_.compare(batch.state, wrong_tree);
  }

  void add_sort() {
    const BuildPlan sort = plan_sort(layout(), check_triangles, sorted_in_place(options_), use_.sorts_values);
    chain_.upload(sort.keys[0], std::span<const uint>(random_words(sort.keys[0].count)));
    chain_.upload(sort.values[0], std::span<const uint>(random_words(sort.values[0].count)));
    chain_.append([=](Chain& chain) { append_sort(chain, sort); });
    chain_.compare(sort.keys[0], "sorts wrong");
    chain_.compare(sort.values[0], "sorts wrong");
    chain_.compare(sort.state, "sorts wrong");
  }

  void add_scan() {
    const ScanPlan scan = plan_scan(layout(), check_words, options_);
    chain_.upload(ScanPlan::words_of(scan.source),
                  std::span<const uint>(random_words(scan.source.count * 4)));
    chain_.append([=](Chain& chain) { append_scan(chain, scan); });
    chain_.compare(scan.target, "computes wrong prefix sums");
    chain_.compare(scan.state, "computes wrong prefix sums");
  }

  const DeviceUse& use_;
  BuildOptions options_;
  std::uint32_t max_turns_;
  CheckChain chain_;
  const std::vector<Triangle> triangles_ = scattered_triangles(check_triangles);
  TreeSlots tree_;
};

}  // namespace

CheckChain check_chain_of(const DeviceProperties& device, const DeviceUse& use, bool lookback) {
  return Check(device, use, lookback).chain();
}

bool CheckChain::same(const Device& device, const Compared& compared, std::span<const std::byte> by_twins,
                      std::span<const std::byte> on_device) const {
  if (compared.like && !rounds_like_the_host(device.properties()))
    return compare_nearly(*compared.like, by_twins, on_device).holds();
  return std::ranges::equal(by_twins, on_device);
}

void CheckChain::upload_to(CpuExecutor& executor) const {
  for (const Upload& upload : uploads_) std::ranges::copy(upload.bytes, executor.at(upload.place));
}

void CheckChain::append_to(Chain& chain) const {
  for (const Part& part : parts_) part.steps(chain);
}

const char* CheckChain::run(Device& device, const CheckFault& fault) const {
  CpuExecutor cpu(layout_);
  GpuExecutor gpu(device, layout_);
  upload_to(cpu);
  for (const Upload& upload : uploads_)
    gpu.arena().upload(upload.place.block, upload.place.offset, upload.bytes);
  Chain by_twins = cpu.chain(), on_device = gpu.chain();
  append_to(by_twins);
  for (const Part& part : parts_) {
    if (part.on_device) part.steps(on_device);
  }
  cpu.run(by_twins.steps());
  const auto twins_bytes = [&](const Bytes& bytes) {
    return std::span<const std::byte>(cpu.at(bytes.place), bytes.count);
  };
  for (const Bytes& bytes : handed_over_)
    gpu.arena().upload(bytes.place.block, bytes.place.offset, twins_bytes(bytes));
  if (fault) fault(on_device.steps());
  gpu.record(on_device.steps()).submit_and_wait(check_limit_seconds);

  std::vector<std::byte> found;
  for (const Compared& compared : compared_) {
    found.resize(compared.bytes.count);
    gpu.arena().download(compared.bytes.place.block, compared.bytes.place.offset, found);
    if (!same(device, compared, twins_bytes(compared.bytes), found)) return compared.wrong;
  }
  return nullptr;
}

}  // namespace coppice
