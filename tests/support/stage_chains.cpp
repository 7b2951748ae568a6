#include "support/stage_chains.h"

#include <algorithm>
#include <limits>
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
#include "stages/stages.h"
#include "support/instances.h"
#include "support/masked_scene.h"
#include "support/moving_scenes.h"
#include "support/path_scene.h"
#include "support/textured_scene.h"

namespace coppice {
namespace {

// A few chains that have all stages between them.
struct Frame {
  std::uint32_t triangles;
  DeviceBuilder builder;
  bool lookback;
  Walk walk;
  uint show = SHOW_COLOR;
  std::uint32_t samples = 1;
  bool keep_hits = true;
  bool lights = false;   // two, which cast shadows
  bool refines = false;  // as a picture whose error is estimated
  bool textures = false;
  bool paths = false;  // of all lobes
  bool alpha = false;  // with lights
};
constexpr Frame frames[] = {
    {1000, DeviceBuilder::ploc, true, Walk::binary},
    {1000, DeviceBuilder::hploc, true, Walk::wide_packets},
    {1000, DeviceBuilder::hploc, true, Walk::wide_single},
    {1000, DeviceBuilder::hploc, true, Walk::wide_packets, SHOW_COLOR, 1, false},
    {300, DeviceBuilder::ploc, true, Walk::brute_force, SHOW_COLOR, 2},
    {SORT_SCAN_TILE + 100, DeviceBuilder::ploc, false, Walk::binary},  // one tile alone sorts without a scan
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_DEPTH},
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_COLOR, 1, true, true},
    {300, DeviceBuilder::ploc, true, Walk::wide_single, SHOW_COLOR, 1, true, true},
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_COLOR, 2, true, false, true},
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_COLOR, 1, true, false, false, true},
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_COLOR, 1, true, false, false, false, true},
    {300, DeviceBuilder::ploc, true, Walk::binary, SHOW_COLOR, 1, true, true, false, false, false, true},
    {300, DeviceBuilder::ploc, true, Walk::wide_packets, SHOW_COLOR, 1, true, true, false, false, false,
     true},
    {300, DeviceBuilder::ploc, true, Walk::wide_single, SHOW_COLOR, 1, true, true, false, false, false,
     true}};
constexpr std::size_t scan_and_copy = std::size(frames), inputs = scan_and_copy + 1, vertices = inputs + 1,
                      refits = vertices + 1, instances = refits + 1, chain_count = instances + 1;

Found run_frame(Device& device, const Frame& frame, const Spoil& spoil) {
  Scene scene = frame.alpha      ? masked_scene(frame.triangles)
                : frame.lights   ? triangles_over_plane(frame.triangles)
                : frame.paths    ? room_of_all_surfaces()
                : frame.textures ? textured_scene(frame.triangles)
                                 : find_hard_case("nested")->make(frame.triangles, 1);
  if (frame.lights) {
    scene.light.shadows = true;
    scene.more_lights.push_back({.is_point = true, .place = {1, 3, 2}, .shadows = true, .origin = ""});
  }
  if (frame.refines) scene.lens.aperture = 0.1f;
  if (frame.paths)
    scene.fog = Fog{.density = 0.2f, .albedo = vec3(0.9f), .anisotropy = 0.2f, .box = {}, .origin = "/fog"};
  if (frame.lights) scene.occlusion = AmbientOcclusion{2};
  SceneArrays arrays = scene_arrays(scene, effects_of(scene));
  arrays.lighting = {};  // padding and all
  if (!frame.lights) arrays.lighting.light_direction = {0.6f, 0.8f, 0};
  arrays.lighting.sky_horizon = {0.8f, 0.9f, 1};
  Layout layout(device.properties().max_block_bytes);
  BuildOptions options;
  options.builder = frame.builder;
  options.lookback = frame.lookback;
  BuildPlan build = plan_build(layout, static_cast<std::uint32_t>(arrays.triangles.size()), options);
  TraceOptions trace_options = test_trace_options(chain_width, chain_height);
  trace_options.walk = frame.walk;
  trace_options.show = frame.show;
  trace_options.samples = frame.samples;
  trace_options.keep_hits = frame.keep_hits;
  trace_options.keep_noise = trace_options.adaptive = frame.refines;
  trace_options.lights = arrays.light_counts;
  trace_options.textures = arrays.texture_counts();
  trace_options.lens = arrays.lens;
  trace_options.paths = arrays.paths.counts;
  trace_options.alpha = arrays.alpha_counts();
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
  AnyHitSlots any{trace.rays, layout.add<uint>("any_hits", trace.band_rays), trace.counters, {}};
  any.filter.alpha = trace.filter.alpha;
  LockstepExecutor executor(device, layout);
  Film film = make_film(scene, {}, chain_width, chain_height, frame.samples);
  film.is_sequence = frame.refines;
  upload_frame(executor, build, trace, arrays, film);
  upload_show(executor, trace.show, Show::depth, {0, 100});
  auto difference = executor.run([&](Chain& chain) {
    append_build(chain, build);
    if (wide) append_wide(chain, build, *wide);
    append_trace(chain, build, trace);
    if (frame.refines) {
      append_noise_sum(chain, trace.noise, frame.samples);
      append_active_pixels(chain, trace.noise, build.state, 0.01);
    }
    if (!frame.keep_hits) return spoil(chain.steps(), executor);
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
  for (uint i = 0; i < chain_width * chain_height; ++i) {
    const float x = static_cast<float>(i % chain_width) / chain_width,
                y = static_cast<float>(i / chain_width) / chain_height;
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

}  // namespace

const std::size_t stage_chain_count = chain_count;

Found run_stage_chain(Device& device, std::size_t chain, const Spoil& spoil) {
  if (chain == vertices) return run_vertices(device, spoil);
  if (chain == refits) return run_refit(device, spoil);
  if (chain == instances) return run_instances(device, spoil);
  if (chain == inputs) return run_inputs(device, spoil);
  return chain == scan_and_copy ? run_scan_and_copy(device, spoil) : run_frame(device, frames[chain], spoil);
}

}  // namespace coppice
