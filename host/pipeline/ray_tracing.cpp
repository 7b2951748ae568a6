#include "apps/ray_tracing.h"

#include "stages/errors.h"

namespace coppice {

namespace {

constexpr double limit_seconds = 600;

}  // namespace

RayTracing::Slots RayTracing::plan(Layout& layout, std::size_t nodes, std::size_t triangles,
                                   std::uint32_t most_rays) {
  Slots slots;
  slots.tree = plan_tree(layout, static_cast<std::uint32_t>(triangles), nodes);
  for (RaySlots* const rays : {&slots.rays, &slots.bounced}) {
    const std::string prefix = rays == &slots.rays ? "" : "bounced_";
    rays->rays = layout.add<Ray>(prefix + "rays", most_rays);
    rays->hits = layout.add<Hit>(prefix + "hits", most_rays);
    rays->counters = layout.add<TraceCounters>(prefix + "counters", 1);
  }
  return slots;
}

RayTracing::RayTracing(CheckedDevice& device, std::span<const Node> nodes,
                       std::span<const Triangle> triangles, std::uint32_t most_rays)
    : layout_(device.device.properties().max_block_bytes),
      slots_(plan(layout_, nodes.size(), triangles.size(), most_rays)),
      gpu_(device.device, layout_),
      cpu_(layout_) {
  state_.active_count = static_cast<uint>((nodes.size() + 1) / 2);
  gpu_.upload(slots_.tree.nodes, nodes);
  cpu_.upload(slots_.tree.nodes, nodes);
  gpu_.upload(slots_.tree.triangles, triangles);
  cpu_.upload(slots_.tree.triangles, triangles);
}

template <class Executor>
void RayTracing::upload_rays(Executor& executor, std::span<const Ray> rays) const {
  std::vector<Hit> misses;
  misses.reserve(rays.size());
  for (const Ray& ray : rays) misses.push_back({ray.t_max, NO_TRIANGLE, 0, 0});
  executor.upload(slots_.rays.rays, rays);
  executor.upload(slots_.rays.hits, std::span<const Hit>(misses));
  executor.upload(slots_.tree.state, std::span<const BuildState>(&state_, 1));
}

template <class Executor>
TracedRays RayTracing::result(Executor& executor, std::size_t ray_count) const {
  TracedRays traced;
  traced.hits = executor.read(Slot<Hit>{slots_.rays.hits.place, ray_count});
  const TraceCounters counters = executor.read(slots_.rays.counters)[0];
  traced.hit_count = std::uint64_t{counters.hits.y} << 32 | counters.hits.x;
  traced.error = describe_error_word(executor.read(slots_.tree.state)[0].error_word);
  return traced;
}

TracedRays RayTracing::on_device(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(gpu_, rays);
  Chain chain = gpu_.chain();
  chain.clear(slots_.rays.counters);
  append_closest_hits(chain, slots_.tree, slots_.rays, static_cast<std::uint32_t>(rays.size()), options);
  const Recorder::Times times = gpu_.record(chain.steps()).submit_and_wait(limit_seconds);
  TracedRays traced = result(gpu_, rays.size());
  traced.ms = times.total_ms;
  return traced;
}

TracedRays RayTracing::by_twins(std::span<const Ray> rays, const TraceOptions& options) {
  upload_rays(cpu_, rays);
  Chain chain = cpu_.chain();
  chain.clear(slots_.rays.counters);
  append_closest_hits(chain, slots_.tree, slots_.rays, static_cast<std::uint32_t>(rays.size()), options);
  cpu_.run(chain.steps());
  return result(cpu_, rays.size());
}

std::vector<Ray> RayTracing::bounce(std::span<const Ray> rays, const TraceOptions& options,
                                    std::uint32_t seed) {
  upload_rays(gpu_, rays);
  Chain chain = gpu_.chain();
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  append_closest_hits(chain, slots_.tree, slots_.rays, ray_count, options);
  append_bounce(chain, slots_.tree, slots_.rays, slots_.bounced, ray_count, seed);
  gpu_.record(chain.steps()).submit_and_wait(limit_seconds);
  return gpu_.read(Slot<Ray>{slots_.bounced.rays.place, ray_count});
}

}  // namespace coppice
