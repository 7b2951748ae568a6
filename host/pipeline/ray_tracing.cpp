#include "pipeline/ray_tracing.h"

#include "pipeline/bounded_submits.h"
#include "pipeline/trace_pieces.h"
#include "stages/errors.h"

namespace coppice {

RayTracing::Slots RayTracing::plan(Layout& layout, std::size_t nodes, std::size_t triangles,
                                   std::uint32_t most_rays, bool wide, std::uint32_t max_turns) {
  Slots slots;
  slots.tree = plan_tree(layout, static_cast<std::uint32_t>(triangles), nodes);
  if (wide) slots.wide = plan_wide(layout, slots.tree, nullptr, max_turns);
  for (RaySlots* const rays : {&slots.rays, &slots.bounced}) {
    const std::string prefix = rays == &slots.rays ? "" : "bounced_";
    rays->rays = layout.add<Ray>(prefix + "rays", most_rays);
    rays->hits = layout.add<Hit>(prefix + "hits", most_rays);
    rays->counters = layout.add<TraceCounters>(prefix + "counters", 1);
  }
  slots.any = {slots.rays.rays, layout.add<uint>("any_hits", most_rays), slots.rays.counters, {}};
  return slots;
}

RayTracing::RayTracing(Device& device, std::span<const Node> nodes, std::span<const Triangle> triangles,
                       std::uint32_t most_rays, bool wide)
    : device_(device),
      layout_(device.properties().max_block_bytes),
      slots_(plan(layout_, nodes.size(), triangles.size(), most_rays, wide, device.properties().max_turns())),
      gpu_(device, layout_),
      cpu_(layout_) {
  state_.active_count = static_cast<uint>((nodes.size() + 1) / 2);
  gpu_.upload(slots_.tree.nodes, nodes);
  cpu_.upload(slots_.tree.nodes, nodes);
  gpu_.upload(slots_.tree.triangles, triangles);
  cpu_.upload(slots_.tree.triangles, triangles);
  if (slots_.wide) convert();
}

void RayTracing::convert() {
  const std::span<const BuildState> state(&state_, 1);
  Chain on_device = gpu_.chain(), by_twins = cpu_.chain();
  gpu_.upload(slots_.tree.state, state);
  append_wide(on_device, slots_.tree, *slots_.wide);
  gpu_.record(on_device.steps()).submit_and_wait(piece_limit_seconds);
  cpu_.upload(slots_.tree.state, state);
  append_wide(by_twins, slots_.tree, *slots_.wide);
  cpu_.run(by_twins.steps());
  if (const std::uint32_t error_word = gpu_.read(slots_.tree.state)[0].error_word)
    throw DeviceError(describe_error_word(error_word));
}

template <class Executor>
void RayTracing::upload_rays(Executor& executor, std::span<const Ray> rays) const {
  if (rays.size() > slots_.rays.rays.count) {
    throw LayoutError("ray tracing planned for " + std::to_string(slots_.rays.rays.count) + " rays got " +
                      std::to_string(rays.size()));
  }
  std::vector<Hit> misses;
  misses.reserve(rays.size());
  for (const Ray& ray : rays) misses.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
  executor.upload(slots_.rays.rays, rays);
  executor.upload(slots_.rays.hits, std::span<const Hit>(misses));
  executor.upload(slots_.tree.state, std::span<const BuildState>(&state_, 1));
  const TraceCounters none{};
  executor.upload(slots_.rays.counters, std::span<const TraceCounters>(&none, 1));
}

template <class Executor>
TracedRays RayTracing::result(Executor& executor, std::size_t ray_count) const {
  TracedRays traced;
  traced.hits = executor.read(Slot<Hit>{slots_.rays.hits.place, ray_count});
  traced.hit_count = counts_of(executor.read(slots_.rays.counters)[0]).hits;
  traced.error_word = executor.read(slots_.tree.state)[0].error_word;
  return traced;
}

Pace& RayTracing::pace_of(const TraceOptions& options) {
  return paces_.try_emplace(options.walk, submit_target_ms(device_.properties()), first_work(options))
      .first->second;
}

double RayTracing::trace(std::size_t ray_count, const TraceOptions& options) {
  const HitPieces pieces(slots_.tree, slots_.rays, static_cast<std::uint32_t>(ray_count), options);
  double ms = 0;
  submit_pieces(gpu_, pieces, pace_of(options), Timestamps::total,
                [&](const SubmittedPiece& piece) { ms += piece.times.total_ms; });
  return ms;
}

TracedRays RayTracing::on_device(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(gpu_, rays);
  const double ms = trace(rays.size(), options);
  TracedRays traced = result(gpu_, rays.size());
  traced.ms = ms;
  return traced;
}

TracedRays RayTracing::by_twins(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(cpu_, rays);
  Chain chain = cpu_.chain();
  append_closest_hits(chain, slots_.tree, slots_.rays, static_cast<std::uint32_t>(rays.size()), options);
  cpu_.run(chain.steps());
  return result(cpu_, rays.size());
}

template <class Executor>
TracedAnyHits RayTracing::any_result(Executor& executor, std::size_t ray_count) const {
  return {executor.read(Slot<uint>{slots_.any.any_hits.place, ray_count}),
          executor.read(slots_.tree.state)[0].error_word, 0};
}

TracedAnyHits RayTracing::any_on_device(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(gpu_, rays);
  const AnyHitPieces pieces(slots_.tree, slots_.any, static_cast<std::uint32_t>(rays.size()), options);
  double ms = 0;
  submit_pieces(gpu_, pieces, pace_of(options), Timestamps::total,
                [&](const SubmittedPiece& piece) { ms += piece.times.total_ms; });
  TracedAnyHits traced = any_result(gpu_, rays.size());
  traced.ms = ms;
  return traced;
}

TracedAnyHits RayTracing::any_by_twins(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(cpu_, rays);
  Chain chain = cpu_.chain();
  append_any_hits(chain, slots_.tree, slots_.any, static_cast<std::uint32_t>(rays.size()), options);
  cpu_.run(chain.steps());
  return any_result(cpu_, rays.size());
}

std::vector<Ray> RayTracing::bounce(std::span<const Ray> rays, const TraceOptions& options,
                                    std::uint32_t seed) {
  upload_rays(gpu_, rays);
  trace(rays.size(), options);
  Chain chain = gpu_.chain();
  append_bounce(chain, slots_.tree, slots_.rays, slots_.bounced, static_cast<std::uint32_t>(rays.size()),
                seed);
  gpu_.record(chain.steps()).submit_and_wait(piece_limit_seconds);
  return gpu_.read(Slot<Ray>{slots_.bounced.rays.place, rays.size()});
}

}  // namespace coppice
