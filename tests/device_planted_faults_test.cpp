// Whatever stage goes wrong, lockstep finds it there: each stage of the table gets a fault, on a device that
// is compared bit for bit and on one that is taken for a GPU. A stage in none of the chains below fails the
// test.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "measure/copy_limit.h"
#include "pipeline/batch.h"
#include "pipeline/refit.h"
#include "pipeline/scan_plan.h"
#include "pipeline/trace_any.h"
#include "pipeline/wide_plan.h"
#include "render/frame.h"
#include "render/moving_vertices.h"
#include "render/show.h"
#include "scene/hard_cases.h"
#include "stages/lockstep_executor.h"
#include "stages/stages.h"
#include "support/instances.h"
#include "support/moving_scenes.h"
#include "support/test_device.h"

namespace coppice {
namespace {

constexpr std::uint32_t width = 61, height = 47;

// A few chains that have all stages between them.
struct Frame {
  std::uint32_t triangles;
  DeviceBuilder builder;
  bool lookback;
  Walk walk;
  uint show = SHOW_COLOR;
  std::uint32_t samples = 1;
};
constexpr Frame frames[] = {
    {1000, DeviceBuilder::ploc, true, Walk::binary},
    {1000, DeviceBuilder::hploc, true, Walk::wide_packets},
    {1000, DeviceBuilder::hploc, true, Walk::wide_single},
    {300, DeviceBuilder::ploc, true, Walk::brute_force, SHOW_COLOR, 2},
    {SORT_SCAN_TILE + 100, DeviceBuilder::ploc, false, Walk::binary},  // one tile alone sorts without a scan
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_DEPTH}};
constexpr std::size_t scan_and_copy = std::size(frames), inputs = scan_and_copy + 1, vertices = inputs + 1,
                      refits = vertices + 1, instances = refits + 1, chain_count = instances + 1;

using Spoil = std::function<void(std::vector<Step>&, const LockstepExecutor&)>;

struct Found {
  std::optional<Difference> difference;
  std::vector<NearlyListing> nearly;
};

Found run_frame(Device& device, const Frame& frame, const Spoil& spoil) {
  const Scene scene = find_hard_case("nested")->make(frame.triangles, 1);
  SceneArrays arrays = scene_arrays(scene);
  arrays.lighting = {};  // padding and all
  arrays.lighting.light_direction = {0.6f, 0.8f, 0};
  arrays.lighting.sky_horizon = {0.8f, 0.9f, 1};
  Layout layout(device.properties().max_block_bytes);
  BuildOptions options;
  options.builder = frame.builder;
  options.lookback = frame.lookback;
  BuildPlan build = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()), options);
  TraceOptions trace_options = test_trace_options(width, height);
  trace_options.walk = frame.walk;
  trace_options.show = frame.show;
  trace_options.samples = frame.samples;
  std::optional<WidePlan> wide;
  if (is_wide(frame.walk)) wide = plan_wide(layout, build, &build);
  const TracePlan trace =
      plan_trace(layout, build, static_cast<std::uint32_t>(arrays.materials.size()), trace_options);
  const RaySlots bounced{layout.add<Ray>("bounced_rays", trace.band_rays),
                         layout.add<Hit>("bounced_hits", trace.band_rays),
                         layout.add<TraceCounters>("bounced_counters", 1)};
  const CandidateSlots boxes{2,
                             trace.rays,
                             layout.add<BoxCandidate>("candidates", 2 * trace.band_rays),
                             layout.add<uint>("candidate_counts", trace.band_rays),
                             trace.counters,
                             {}};
  const AnyHitSlots any{trace.rays, layout.add<uint>("any_hits", trace.band_rays), trace.counters, {}};
  LockstepExecutor executor(device, layout);
  upload_frame(executor, build, trace, arrays, make_film(scene, {}, width, height, frame.samples));
  upload_show(executor, trace.show, Show::depth, {0, 100});
  auto difference = executor.run([&](Chain& chain) {
    append_build(chain, build);
    if (wide) append_wide(chain, build, *wide);
    append_trace(chain, build, trace);
    append_bounce(chain, build, trace, bounced, trace.band_rays, 1);
    if (frame.walk != Walk::brute_force) append_any_hits(chain, build, any, trace.band_rays, trace_options);
    append_candidates(chain, build, boxes, trace.band_rays, trace_options);
    append_misses(chain, trace, trace.band_rays);
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

Found run_scan_and_copy(Device& device, const Spoil& spoil) {
  Layout layout(device.properties().max_block_bytes);
  BuildOptions options;
  options.lookback = false;
  const ScanPlan scan = plan_scan(layout, 3 * SCAN_TILE * 4, options);
  const CopyPlan copy = plan_copy(layout, 100000);
  LockstepExecutor executor(device, layout);
  executor.upload(scan.source, std::span<const uvec4>(std::vector<uvec4>(scan.source.count, uvec4(3))));
  executor.upload(copy.source, std::span<const uvec4>(std::vector<uvec4>(copy.source.count, uvec4(5))));
  auto difference = executor.run([&](Chain& chain) {
    append_scan(chain, scan);
    append_copy(chain, copy, 100000);
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

// Vertices to a batch of trees, and boxes as they are given.
Found run_inputs(Device& device, const Spoil& spoil) {
  constexpr std::uint32_t count = 300;
  const std::vector<Triangle> triangles = random_triangles(count, 1);
  const std::vector<Aabb> boxes(count, Aabb{vec3(1), vec3(2)});
  const std::vector<BatchRange> ranges = {{0, 100}, {100, 200}};
  Layout layout(device.properties().max_block_bytes);
  const auto corners = layout.add<Triangle>("vertices", count);
  const auto given = layout.add<Aabb>("given", count);
  const BatchPlan batch = plan_batch(layout, count, 2, {});
  const PrimitiveSlots primitives = plan_primitives(layout, count, PrimitiveKind::boxes);
  LockstepExecutor executor(device, layout);
  executor.upload(corners, std::span<const Triangle>(triangles));
  executor.upload(given, std::span<const Aabb>(boxes));
  executor.upload(batch.ranges, std::span<const BatchRange>(ranges));
  auto difference = executor.run([&](Chain& chain) {
    VertexTriangles input{.vertices = {chain.at(corners).value}, .vertex_count = 3 * count};
    append_batch(chain, batch, {input, {}});
    append_primitives(chain, primitives, {GivenBoxes{{chain.at(given).value}}, {}});
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

Found run_vertices(Device& device, const Spoil& spoil) {
  const Scene scene = all_that_moves(20);
  Layout layout(device.properties().max_block_bytes);
  const MovingVertices plan = plan_vertices(layout, *scene.motion, 180);
  const MotionSlots told = plan_motion(layout, *scene.motion);
  LockstepExecutor executor(device, layout);
  upload_vertices(executor, plan, *scene.motion, std::span<const uvec3>(scene.indices));
  upload_step(executor, told, motion_step(*scene.motion, pose_at(*scene.motion, 0.4), 0.4));
  auto difference = executor.run([&](Chain& chain) {
    append_vertices(chain, plan, told, *scene.motion);
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

// A tree in which some triangles are absent, all of which then go elsewhere; high enough for all stages.
Found run_refit(Device& device, const Spoil& spoil) {
  std::vector<Triangle> triangles = scene_arrays(find_hard_case("nested")->make(1000, 1)).triangles;
  std::vector<Triangle> moved = triangles;
  for (Triangle& t : moved) t = {t.a + 0.25f, t.b + 0.25f, t.c + 0.25f};
  const auto count = static_cast<std::uint32_t>(triangles.size());
  for (std::uint32_t i = 0; i < count; i += 9) triangles[i].b.y = std::numeric_limits<float>::infinity();
  Layout layout(device.properties().max_block_bytes);
  const auto corners = layout.add<Triangle>("corners", count);
  const BuildPlan build = plan_build(layout, count, {});
  const RefitPlan refit = plan_refit(layout, build, &build);
  LockstepExecutor executor(device, layout);
  executor.upload(build.triangles, std::span<const Triangle>(triangles));
  executor.upload(corners, std::span<const Triangle>(moved));
  auto difference = executor.run([&](Chain& chain) {
    append_build(chain, build);
    append_refit_order(chain, build, refit);
    append_triangles(chain, build.triangles,
                     {.vertices = {chain.at(corners).value}, .vertex_count = 3 * count});
    append_refit(chain, build, refit);
    append_tree_cost(chain, build, refit);
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

// Two levels, of instances that move.
Found run_instances(Device& device, const Spoil& spoil) {
  InstancesToTrace scene;
  scene.meshes = {random_triangles(200, 1, 0.5f), random_triangles(30, 2, 0.5f)};
  for (uint i = 0; i < 100; ++i) scene.mesh_index.push_back(i % 2);
  Random random(4);
  for (uint i = 0; i < 100; ++i) scene.transforms.push_back(random_transform(random, 1, 2));
  std::vector<Ray> rays;
  for (uint i = 0; i < width * height; ++i) {
    const float x = static_cast<float>(i % width) / width, y = static_cast<float>(i / width) / height;
    rays.push_back({{8, 0, 0}, 0, {-1, y - 0.5f, x - 0.5f}, 1e30f});
  }
  Layout layout(device.properties().max_block_bytes);
  const InstanceSlots slots = plan_for(layout, scene, rays.size());
  PlacedHitSlots placed = plan_placed_hits(layout, slots.plan, static_cast<std::uint32_t>(rays.size()));
  placed.hit_instances = slots.hit_instances;
  LockstepExecutor executor(device, layout);
  upload_instances(executor, slots, scene, rays);
  const std::vector<uint> materials(placed.mesh_materials.count, 5);
  executor.upload(placed.mesh_materials, std::span<const uint>(materials));
  auto difference = executor.run([&](Chain& chain) {
    append_moves(chain, slots.plan, slots.swarm, 1);
    append_all(chain, slots, test_trace_options(1, 1));
    append_placed_hits(chain, slots.plan, slots.rays, placed, 0, static_cast<std::uint32_t>(rays.size()));
    spoil(chain.steps(), executor);
  });
  return {std::move(difference), {executor.nearly().begin(), executor.nearly().end()}};
}

Found run_chain(Device& device, std::size_t chain, const Spoil& spoil) {
  if (chain == vertices) return run_vertices(device, spoil);
  if (chain == refits) return run_refit(device, spoil);
  if (chain == instances) return run_instances(device, spoil);
  if (chain == inputs) return run_inputs(device, spoil);
  return chain == scan_and_copy ? run_scan_and_copy(device, spoil) : run_frame(device, frames[chain], spoil);
}

// --- A twin that does its work and then spoils what it wrote. A twin is a plain function, so what it is
// about is global.

struct Word {
  std::string slot;
  std::uint64_t index;  // of the element
};

using Damage = void (*)(std::span<std::uint32_t> words, const std::vector<bool>& changed);

struct Planting {
  const StageDeclaration* stage = nullptr;
  const LockstepExecutor* executor = nullptr;
  std::string_view only;  // slot; empty: the first that the stage changes
  Damage damage = nullptr;
  std::optional<Word> where;
} planting;

// The slot with all that lies behind it, up to where nothing is promised any more.
std::span<std::uint32_t> words_of(const SlotListing& slot) {
  auto* const first = reinterpret_cast<std::uint32_t*>(planting.executor->cpu().at(slot.place));
  return {first, (slot.bytes() + Layout::guard_bytes) / 4};
}

void run_and_spoil(const void* args) {
  const std::vector<SlotListing>& slots = planting.executor->layout().slots();
  std::vector<std::vector<std::uint32_t>> before;
  for (const SlotListing& slot : slots) before.emplace_back(words_of(slot).begin(), words_of(slot).end());
  planting.stage->twin(args);
  for (std::size_t i = 0; i < slots.size() && !planting.where; ++i) {
    const std::span<std::uint32_t> words = words_of(slots[i]);
    std::vector<bool> changed(words.size());
    for (std::size_t k = 0; k < words.size(); ++k) changed[k] = words[k] != before[i][k];
    const auto first = std::ranges::find(changed, true) - changed.begin();
    if (first == std::ssize(changed) || !(planting.only.empty() || slots[i].name == planting.only)) continue;
    planting.where = Word{slots[i].name, first * 4 / slots[i].element_bytes};
    planting.damage(words, changed);
  }
}

Found run_with_fault(Device& device, std::size_t chain, const StageDeclaration& stage, Damage damage,
                     std::string_view slot = {}) {
  static StageDeclaration faulty;
  faulty = stage;
  faulty.twin = run_and_spoil;
  return run_chain(device, chain, [&](std::vector<Step>& steps, const LockstepExecutor& executor) {
    planting = {&stage, &executor, slot, damage, {}};
    for (Step& step : steps) {
      if (stage_of(step) == &stage) dispatch_of(step)->stage = &faulty;
    }
  });
}

// Which chain has the stage first.
std::vector<std::set<const StageDeclaration*>> stages_of_chains(Device& device) {
  std::vector<std::set<const StageDeclaration*>> stages(chain_count);
  for (std::size_t chain = 0; chain < chain_count; ++chain) {
    run_chain(device, chain, [&](std::vector<Step>& steps, const LockstepExecutor&) {
      for (const Step& step : steps) stages[chain].insert(stage_of(step));
      steps.clear();
    });
  }
  return stages;
}

void one_bit(std::span<std::uint32_t> words, const std::vector<bool>& changed) {
  words[std::ranges::find(changed, true) - changed.begin()] ^= 1;
}

void all_that_changed(std::span<std::uint32_t> words, const std::vector<bool>& changed) {
  for (std::size_t i = 0; i < words.size(); ++i) words[i] ^= changed[i] ? 0x40000004u : 0;
}

void one_past_the_end(std::span<std::uint32_t> words, const std::vector<bool>&) {
  words[words.size() - Layout::guard_bytes / 4] ^= 1;
}

void last_of_the_guard(std::span<std::uint32_t> words, const std::vector<bool>&) { words.back() ^= 1; }

class PlantedFaults : public DeviceTest {
 protected:
  static Device& like_a_gpu() {
    static Device device({"", false, true});
    return device;
  }

  // In every stage, by the damage: named by stage, slot and, where one word is spoilt, by index.
  static void expect_found(Device& device, Damage (*damage_for)(const StageDeclaration&)) {
    const auto stages = stages_of_chains(device);
    for (const StageDeclaration* const stage : all_stages()) {
      const auto chain = std::ranges::find_if(stages, [&](const auto& its) { return its.contains(stage); });
      ASSERT_NE(chain, stages.end()) << stage->name << " is in no chain of this test: add it to one";
      const Damage damage = damage_for(*stage);
      const Found found = run_with_fault(device, chain - stages.begin(), *stage, damage);
      ASSERT_TRUE(planting.where) << stage->name << " changed nothing";
      ASSERT_TRUE(found.difference) << stage->name << ": not noticed in " << planting.where->slot;
      EXPECT_EQ(found.difference->stage, stage->name);
      EXPECT_EQ(found.difference->slot, planting.where->slot) << stage->name;
      if (damage == one_bit) {
        EXPECT_EQ(found.difference->index, planting.where->index) << stage->name;
      }
    }
  }
};

TEST_F(PlantedFaults, OneWrongBitOfAnyStageIsFound) {
  if (!rounds_like_the_host(test_device().properties())) GTEST_SKIP() << "not compared bit for bit";
  expect_found(test_device(), [](const StageDeclaration&) -> Damage { return one_bit; });
}

// LikeAGpu is in the names of what runs on the reference driver only.
using PlantedFaultsLikeAGpu = PlantedFaults;

TEST_F(PlantedFaultsLikeAGpu, AnyStageWithoutAToleranceIsHeldToEveryBitAndTheOthersToTheirs) {
  expect_found(like_a_gpu(), [](const StageDeclaration& stage) -> Damage {
    return stage.nearly.empty() ? one_bit : all_that_changed;
  });
}

// What else a stage with a tolerance may do wrong.
TEST_F(PlantedFaultsLikeAGpu, NoToleranceReachesBeyondItsSlot) {
  const auto stages = stages_of_chains(like_a_gpu());
  for (const StageDeclaration* const stage : all_stages()) {
    for (const NearlySlot& nearly : stage->nearly) {
      const auto chain =
          std::ranges::find_if(stages, [&](const auto& its) { return its.contains(stage); }) - stages.begin();
      for (const Damage damage : {one_past_the_end, last_of_the_guard}) {
        const Found found = run_with_fault(like_a_gpu(), chain, *stage, damage, nearly.slot);
        ASSERT_TRUE(planting.where && found.difference) << stage->name << ", " << nearly.slot;
        EXPECT_EQ(found.difference->stage, stage->name);
        EXPECT_EQ(found.difference->slot, nearly.slot) << "in " << stage->name;
      }
    }
  }
}

// One ray of 7 goes through what it should hit; all hit another triangle, or farther away; all are some
// roundings off.
TEST_F(PlantedFaultsLikeAGpu, HitsAreComparedAsHits) {
  const Damage lost = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < width * height; hit += 7) {
      if (changed[4 * hit + 1]) words[4 * hit] = 0x7f800000, words[4 * hit + 1] = NO_TRIANGLE;
    }
  };
  const Damage other = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < width * height; ++hit) words[4 * hit + 1] ^= changed[4 * hit + 1];
  };
  const Damage farther = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < width * height; ++hit) words[4 * hit] += changed[4 * hit + 1] ? 1024 : 0;
  };
  const Damage roundings = [](std::span<std::uint32_t> words, const std::vector<bool>& changed) {
    for (std::size_t hit = 0; hit < width * height; ++hit) words[4 * hit] += changed[4 * hit + 1] ? 3 : 0;
  };
  const StageDeclaration* const tracers[] = {&stages::trace_closest, &stages::trace_wide,
                                             &stages::trace_wide_single};
  for (std::size_t chain = 0; chain < std::size(tracers); ++chain) {
    for (const Damage damage : {lost, other, farther}) {
      const Found found = run_with_fault(like_a_gpu(), chain, *tracers[chain], damage, "hits");
      ASSERT_TRUE(found.difference) << tracers[chain]->name
                                    << (damage == lost    ? ", lost"
                                        : damage == other ? ", other"
                                                          : ", farther");
      EXPECT_EQ(found.difference->stage, tracers[chain]->name);
      EXPECT_EQ(found.difference->slot, "hits");
      EXPECT_NE(found.difference->why, "");
    }
    const Found found = run_with_fault(like_a_gpu(), chain, *tracers[chain], roundings, "hits");
    EXPECT_FALSE(found.difference) << found.difference->stage << ", " << found.difference->slot << ": "
                                   << found.difference->why;
    const auto hits = std::ranges::find_if(
        found.nearly, [](const NearlyListing& one) { return one.slot == std::string_view("hits"); });
    ASSERT_NE(hits, found.nearly.end());
    EXPECT_GT(hits->sum.differing, 50u);
    EXPECT_EQ(hits->sum.beyond, 0u);
  }
}

// Memory that no slot holds, and steps that are no stage.
TEST_F(PlantedFaults, AlsoBetweenSlotsAndAfterClears) {
  Layout layout(test_device().properties().max_block_bytes);
  const auto first = layout.add<uint>("first", 3), second = layout.add<uint>("second", 5);
  for (const std::uint64_t byte :
       {12u, 255u, 256u, 511u}) {  // the gap that aligns the next slot, and the guard
    LockstepExecutor executor(test_device(), layout);
    *(executor.cpu().at(first.place) + byte) = std::byte{1};
    const auto difference = executor.run([&](Chain& chain) { chain.clear(second); });
    ASSERT_TRUE(difference) << byte;
    EXPECT_EQ(difference->slot, "first");
    EXPECT_EQ(difference->index, byte / 4);
  }
  LockstepExecutor executor(test_device(), layout);
  executor.upload(second, std::span<const uint>(std::vector<uint>{1, 2, 3, 4, 5}));
  bool on_device = true;
  const auto difference = executor.run([&](Chain& chain) {
    chain.clear(second);
    if (!std::exchange(on_device, false))
      std::get<Clear>(chain.steps()[0]).place.offset += 4;  // the host leaves the first word
  });
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->stage, "clear");
  EXPECT_EQ(difference->slot, "second");
  EXPECT_EQ(difference->index, 0u);
}

}  // namespace
}  // namespace coppice
