#include <algorithm>

#include "stages/divide_up.h"
#include "stages/stages.h"
#include "stages/traffic_shares.h"

// What the stages of traces and pictures move at least: "cost" in docs/kernels.md.
namespace coppice::traffic {

namespace {

constexpr Bytes ray_and_hit = sizeof(Ray) + 2 * sizeof(Hit);  // the hit is read and written
constexpr Bytes ray_and_word = sizeof(Ray) + sizeof(uint);
// Of a hit, with the word that says whether rays pass. How many others let rays through, nobody counts.
constexpr Bytes alpha_triangle = sizeof(Triangle) + sizeof(uint);

// Of a sum over the whole trace, the part that `rays` of its rays have.
Bytes share(Bytes sum, Bytes rays, const RunCounts& counts) {
  if (counts.rays == 0) return 0;
  return static_cast<Bytes>(static_cast<double>(sum) * static_cast<double>(rays) /
                            static_cast<double>(counts.rays));
}

// Of rays by which paths go on, those of `rays` rays of the picture at one bounce; `visited` is what the
// camera's rays visit.
Bytes bounced_bytes(Bytes rays, Bytes per_ray, Bytes visited, const RunCounts& counts) {
  const double part = static_cast<double>(rays) / static_cast<double>(counts.paths.could_be);
  const double a_step = static_cast<double>(visited) / static_cast<double>(std::max<Bytes>(counts.steps, 1));
  return static_cast<Bytes>(part * (static_cast<double>(counts.paths.rays) * static_cast<double>(per_ray) +
                                    static_cast<double>(counts.paths.steps) * a_step));
}

// Of a walk that visits so much over the whole trace.
template <class Args>
Bytes walk_bytes(const Args& args, Bytes per_ray, Bytes visited, const RunCounts& counts) {
  if (args.count_at.value && counts.paths.could_be)
    return bounced_bytes(args.ray_count, per_ray, visited, counts);
  const Bytes rays = args.count_at.value ? std::min<Bytes>(args.ray_count, counts.rays) : args.ray_count;
  return rays * per_ray + share(visited, rays, counts);
}

// Of a ray, where its steps are kept.
template <class Args>
Bytes kept_steps(const Args& args) {
  return args.ray_steps.value ? sizeof(uint) : 0;
}

Bytes pairs_of(const RunCounts& counts) { return counts.steps * 2 * sizeof(Node); }
Bytes wide_nodes_of(const RunCounts& counts) { return counts.steps * sizeof(WideNode); }
Bytes triangles_of(const RunCounts& counts) { return counts.hits * sizeof(Triangle); }
Bytes alpha_triangles_of(const RunCounts& counts) { return counts.hits * alpha_triangle; }

Bytes occlusion_share(Bytes sum, Bytes rays, const RunCounts& counts) {
  return part_of(counts.occlusion, sum, rays);
}

// Both take the same stages.
RunCounts::Secondary secondary_of(const RunCounts& counts) {
  const RunCounts::Secondary &a = counts.shadow, &b = counts.occlusion;
  return {a.could_be + b.could_be, a.rays + b.rays, a.hits + b.hits, a.steps + b.steps};
}

Bytes secondary_walk_bytes(const RunCounts::Secondary& secondary, Bytes rays, Bytes step, Bytes triangle) {
  return part_of(secondary, secondary.rays, rays) * ray_and_word +
         part_of(secondary, secondary.steps * step + secondary.hits * triangle, rays);
}

// Of a walk that ends at the first hit.
template <class Args>
Bytes any_bytes(const Args& args, Bytes step, Bytes triangle, const RunCounts& counts) {
  if (const auto secondary = secondary_of(counts); secondary.could_be)
    return secondary_walk_bytes(secondary, args.ray_count, step, triangle);
  return walk_bytes(args, ray_and_word, counts.steps * step + counts.hits * triangle, counts);
}

}  // namespace

Bytes camera_rays(const CameraRaysArgs& a, const RunCounts&) {
  return Bytes{a.ray_count} * (sizeof(Ray) + sizeof(Hit));
}

Bytes trace_misses(const TraceMissesArgs& a, const RunCounts& counts) {
  return walk_bytes(a, sizeof(Ray) + sizeof(Hit), 0, counts);
}

Bytes trace_closest(const TraceClosestArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a), pairs_of(counts) + triangles_of(counts), counts);
}

Bytes trace_wide(const TraceWideArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a),
                    counts.steps / TRACE_PACKET * sizeof(WideNode) + triangles_of(counts), counts);
}

Bytes trace_wide_single(const TraceWideArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a), wide_nodes_of(counts) + triangles_of(counts), counts);
}

Bytes trace_any(const TraceAnyArgs& a, const RunCounts& counts) {
  return any_bytes(a, 2 * sizeof(Node), sizeof(Triangle), counts);
}

Bytes trace_wide_any(const TraceWideAnyArgs& a, const RunCounts& counts) {
  return any_bytes(a, sizeof(WideNode), sizeof(Triangle), counts);
}

Bytes trace_closest_alpha(const TraceClosestAlphaArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a), pairs_of(counts) + alpha_triangles_of(counts), counts);
}

Bytes trace_wide_alpha(const TraceWideAlphaArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a),
                    counts.steps / TRACE_PACKET * sizeof(WideNode) + alpha_triangles_of(counts), counts);
}

Bytes trace_wide_single_alpha(const TraceWideAlphaArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_hit + kept_steps(a), wide_nodes_of(counts) + alpha_triangles_of(counts),
                    counts);
}

Bytes trace_any_alpha(const TraceAnyAlphaArgs& a, const RunCounts& counts) {
  return any_bytes(a, 2 * sizeof(Node), alpha_triangle, counts);
}

Bytes trace_wide_any_alpha(const TraceWideAnyAlphaArgs& a, const RunCounts& counts) {
  return any_bytes(a, sizeof(WideNode), alpha_triangle, counts);
}

// Of each ray with candidates at least one is written.
Bytes trace_candidates(const TraceCandidatesArgs& a, const RunCounts& counts) {
  return walk_bytes(a, ray_and_word, pairs_of(counts) + counts.hits * sizeof(BoxCandidate), counts);
}

Bytes move_instances(const MoveInstancesArgs& a, const RunCounts&) {
  return Bytes{a.instance_count} * 2 * sizeof(InstanceTransform);
}

// Meshes and their roots are few.
Bytes instance_boxes(const InstanceBoxesArgs& a, const RunCounts&) {
  const Bytes corners = a.corners.value ? sizeof(Triangle) : 0;
  return Bytes{a.instance_count} *
         (sizeof(InstanceTransform) + 4 + sizeof(PlacedInstance) + sizeof(Aabb) + corners);
}

// Of each hit the way to the triangle at least: the instance and its transform.
Bytes trace_instances(const TraceInstancesArgs& a, const RunCounts& counts) {
  return a.ray_count * (ray_and_hit + 4 + kept_steps(a)) + share(pairs_of(counts), a.ray_count, counts) +
         share(counts.hits, a.ray_count, counts) *
             (sizeof(PlacedInstance) + sizeof(InstanceTransform) + sizeof(Triangle));
}

Bytes place_hits(const PlaceHitsArgs& a, const RunCounts& counts) {
  return a.ray_count * (sizeof(Hit) + 4 + sizeof(Triangle) + 4 + (a.primitives.value ? 4 : 0)) +
         share(counts.hits, a.ray_count, counts) *
             (4 + sizeof(uint) + sizeof(InstanceTransform) + sizeof(Triangle) + 4);
}

Bytes trace_brute_force(const TraceBruteForceArgs& a, const RunCounts&) {
  return a.ray_count * ray_and_hit + a.triangle_count * sizeof(Triangle);
}

Bytes bounce_rays(const BounceRaysArgs& a, const RunCounts& counts) {
  return a.ray_count * (2 * (sizeof(Ray) + sizeof(Hit))) +
         share(counts.hits, a.ray_count, counts) * sizeof(Triangle);
}

Bytes shade(const ShadeArgs& a, const RunCounts& counts) {
  const Bytes radiance = sizeof(vec3) * (a.sample_index == 0 ? 1 : 2);
  return a.ray_count * (sizeof(Ray) + 4 + radiance) +
         share(counts.hits, a.ray_count, counts) * (4 + sizeof(SurfaceMaterial) + sizeof(Triangle));
}

// Of each ray its triangle, of a hit what it is textured by: one map, of two levels with four texels each,
// and its material.
Bytes texture_hits(const TextureHitsArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 +
         share(counts.hits, a.ray_count, counts) *
             (sizeof(Hit) - 4 + sizeof(vec3) + sizeof(Triangle) + 4 + sizeof(TexturedMaterial) + 8 +
              sizeof(TextureHeader) + 8 * 4 + sizeof(CornerAttributes) + sizeof(SurfaceMaterial));
}

// Of each ray its hit and its mark, of a hit its direction and its surface.
Bytes shadow_marks(const ShadowMarksArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * (sizeof(Hit) + 4) +
         share(counts.hits, a.ray_count, counts) *
             (sizeof(vec3) + 4 + sizeof(SurfaceMaterial) + sizeof(Triangle));
}

// Of each ray its mark and its place.
Bytes shadow_rays(const ShadowRaysArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 8 + shadow_share(counts.shadow.rays, a.ray_count, counts) *
                                      (sizeof(Hit) + sizeof(vec3) + sizeof(Triangle) + sizeof(Ray));
}

// Of each ray its triangle, of a hit that some light reaches all that is shaded.
Bytes shade_lights(const ShadeLightsArgs& a, const RunCounts& counts) {
  constexpr Bytes of_surface =
      sizeof(Hit) - 4 + sizeof(vec3) + 4 + sizeof(SurfaceMaterial) + sizeof(Triangle) + 2 * sizeof(vec3);
  if (a.marks.value == 0)
    return Bytes{a.ray_count} * 4 + share(counts.hits, a.ray_count, counts) * of_surface;
  return Bytes{a.ray_count} * 4 + share(counts.hits, a.ray_count, counts) * 4 +
         shadow_share(counts.shadow.rays, a.ray_count, counts) * 8 +
         shadow_share(counts.shadow.rays - counts.shadow.hits, a.ray_count, counts) * of_surface;
}

// Of each ray its triangle and its mark, of a hit its surface.
Bytes occlusion_marks(const OcclusionMarksArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * (4 + 4) +
         share(counts.hits, a.ray_count, counts) * (4 + sizeof(SurfaceMaterial));
}

// Of each ray its mark and its place.
Bytes occlusion_rays(const OcclusionRaysArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 8 + occlusion_share(counts.occlusion.rays, a.ray_count, counts) *
                                      (sizeof(Hit) + sizeof(vec3) + sizeof(Triangle) + sizeof(Ray));
}

// Of each ray its mark, of those with a ray of their own what it has hit, of those that it has not what is
// shaded.
Bytes shade_ambient(const ShadeAmbientArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 + occlusion_share(counts.occlusion.rays, a.ray_count, counts) * 8 +
         occlusion_share(counts.occlusion.rays - counts.occlusion.hits, a.ray_count, counts) *
             (4 + 4 + sizeof(SurfaceMaterial) + 2 * sizeof(vec3));
}

// Of each ray its steps or its triangle, of each hit what is shown of it.
Bytes show(const ShowArgs& a, const RunCounts& counts) {
  const Bytes radiance = sizeof(vec3) * (a.sample_index == 0 ? 1 : 2);
  Bytes of_hit = 0;
  if (a.view == SHOW_NORMALS) of_hit = sizeof(Triangle);
  if (a.view == SHOW_DEPTH || a.view == SHOW_RANKS || a.view == SHOW_GROUPS) of_hit = sizeof(uint);
  const bool names_instances = a.view == SHOW_RANKS || a.view == SHOW_GROUPS || a.view == SHOW_INSTANCES;
  if (a.hit_instances.value && names_instances) of_hit += sizeof(uint);
  if (a.hit_instances.value && a.view == SHOW_IDS) of_hit += 2 * sizeof(uint);
  return a.ray_count * (sizeof(uint) + radiance) + share(counts.hits, a.ray_count, counts) * of_hit;
}

Bytes shade_pixels(const ShadePixelsArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * (4 + 4) +
         share(counts.hits, a.ray_count, counts) * (4 + sizeof(SurfaceMaterial) + sizeof(Triangle));
}

Bytes trace_pixels(const TracePixelsArgs& a, const RunCounts& counts) {
  return Bytes{a.ray_count} * 4 + share(counts.steps / TRACE_PACKET * sizeof(WideNode) +
                                            counts.hits * (4 + sizeof(SurfaceMaterial) + sizeof(Triangle)),
                                        a.ray_count, counts);
}

Bytes sample_add(const SampleAddArgs& a, const RunCounts&) {
  const Bytes kept = sizeof(vec3) + sizeof(LuminanceSums);
  return a.pixel_count * (sizeof(vec3) + kept * (a.sample_index == 0 ? 1 : 2));
}

Bytes noise_sum(const NoiseSumArgs& a, const RunCounts&) {
  const Bytes of_value = a.luminance.value ? sizeof(LuminanceSums) : sizeof(float);
  return a.count * of_value + Bytes{divide_up(a.count, NOISE_SUM_RUN)} * sizeof(float);
}

Bytes noise_marks(const NoiseMarksArgs& a, const RunCounts&) {
  return Bytes{a.pixel_count} * (sizeof(LuminanceSums) + 2 * sizeof(uint));
}

// Nothing of the list, whose length is not known here.
Bytes noise_pixels(const NoisePixelsArgs& a, const RunCounts&) {
  return Bytes{a.pixel_count} * 2 * sizeof(uint);
}

Bytes resolve(const ResolveArgs& a, const RunCounts&) { return Bytes{a.ray_count} * (sizeof(vec3) + 4); }

}  // namespace coppice::traffic
