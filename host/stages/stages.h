#pragma once

#include "interface/alpha.h"
#include "interface/batch.h"
#include "interface/bounds.h"
#include "interface/copy.h"
#include "interface/fog.h"
#include "interface/gather.h"
#include "interface/hploc.h"
#include "interface/instances.h"
#include "interface/lights.h"
#include "interface/morton.h"
#include "interface/occlusion.h"
#include "interface/paths.h"
#include "interface/ploc.h"
#include "interface/refine.h"
#include "interface/refit.h"
#include "interface/scan.h"
#include "interface/shade.h"
#include "interface/show.h"
#include "interface/sort.h"
#include "interface/texture_hits.h"
#include "interface/trace.h"
#include "interface/vertex.h"
#include "interface/wide.h"
#include "stages/run_counts.h"
#include "stages/stage.h"

// THE TABLE. A line here, a kernel kernels/<stem>.comp, a twin host/twins/<stem>.cpp and a model of its
// traffic (traffic_of_*.cpp) make a stage; without one of them nothing links. After its arguments come its
// kernel's specialization constants, and what of its result only nearly equals the twin's on a GPU, see
// below.
#define COPPICE_STAGES(STAGE)                                                             \
  STAGE(vertex_sequence, VertexSequenceArgs, NoConstants, exactly)                        \
  STAGE(vertex_morph, VertexMorphArgs, NoConstants, exactly)                              \
  STAGE(vertex_deform, VertexDeformArgs, NoConstants, exactly)                            \
  STAGE(vertex_pose, VertexPoseArgs, NoConstants, exactly)                                \
  STAGE(gather_triangles, GatherTrianglesArgs, NoConstants, exactly)                      \
  STAGE(primitive_bounds, PrimitiveBoundsArgs, NoConstants, exactly)                      \
  STAGE(box_bounds, BoxBoundsArgs, NoConstants, exactly)                                  \
  STAGE(morton_codes, MortonCodesArgs, NoConstants, exactly)                              \
  STAGE(sort_histogram, SortHistogramArgs, NoConstants, exactly)                          \
  STAGE(sort_digit_scan, SortDigitScanArgs, NoConstants, exactly)                         \
  STAGE(sort_pass, SortPassArgs, SortPassConstants, exactly)                              \
  STAGE(sort_tile_counts, SortScatterArgs, SortTileConstants, exactly)                    \
  STAGE(sort_tile_scan, SortTileScanArgs, SortTileScanConstants, exactly)                 \
  STAGE(sort_scatter, SortScatterArgs, SortScatterConstants, exactly)                     \
  STAGE(ploc_leaves, PlocLeavesArgs, NoConstants, exactly)                                \
  STAGE(ploc_tile_counts, PlocMergeArgs, PlocMergeConstants, exactly)                     \
  STAGE(ploc_tile_scan, PlocTileScanArgs, NoConstants, exactly)                           \
  STAGE(ploc_merge, PlocMergeArgs, PlocMergeConstants, exactly)                           \
  STAGE(ploc_finish, PlocFinishArgs, PlocFinishConstants, exactly)                        \
  STAGE(hploc_build, HplocBuildArgs, HplocBuildConstants, exactly)                        \
  STAGE(batch_build, BatchBuildArgs, BatchBuildConstants, exactly)                        \
  STAGE(wide_root, WideCollapseArgs, NoConstants, exactly)                                \
  STAGE(wide_collapse, WideCollapseArgs, NoConstants, exactly)                            \
  STAGE(wide_collapse_rest, WideCollapseRestArgs, NoConstants, exactly)                   \
  STAGE(wide_sizes_rest, WideSizesRestArgs, NoConstants, exactly)                         \
  STAGE(wide_sizes, WideSizesArgs, NoConstants, exactly)                                  \
  STAGE(wide_quantise, WideQuantiseArgs, NoConstants, exactly)                            \
  STAGE(refit_keys, RefitKeysArgs, NoConstants, exactly)                                  \
  STAGE(refit_levels, RefitLevelsArgs, NoConstants, exactly)                              \
  STAGE(refit_absent, RefitAbsentArgs, NoConstants, exactly)                              \
  STAGE(refit_boxes, RefitBoxesArgs, NoConstants, exactly)                                \
  STAGE(refit_rest, RefitRestArgs, NoConstants, exactly)                                  \
  STAGE(refit_appeared, RefitAppearedArgs, NoConstants, exactly)                          \
  STAGE(tree_areas, TreeAreasArgs, NoConstants, exactly)                                  \
  STAGE(tree_area_sum, TreeAreaSumArgs, NoConstants, exactly)                             \
  STAGE(camera_rays, CameraRaysArgs, CameraRaysConstants, nearly_rays)                    \
  STAGE(trace_misses, TraceMissesArgs, NoConstants, exactly)                              \
  STAGE(trace_closest, TraceClosestArgs, TraceClosestConstants, nearly_hits)              \
  STAGE(trace_wide, TraceWideArgs, TraceWideConstants, nearly_hits)                       \
  STAGE(trace_wide_single, TraceWideArgs, TraceWideConstants, nearly_hits)                \
  STAGE(trace_any, TraceAnyArgs, TraceClosestConstants, nearly_any_hits)                  \
  STAGE(trace_wide_any, TraceWideAnyArgs, TraceWideConstants, nearly_any_hits)            \
  STAGE(trace_closest_alpha, TraceClosestAlphaArgs, TraceClosestConstants, nearly_hits)   \
  STAGE(trace_wide_alpha, TraceWideAlphaArgs, TraceWideConstants, nearly_hits)            \
  STAGE(trace_wide_single_alpha, TraceWideAlphaArgs, TraceWideConstants, nearly_hits)     \
  STAGE(trace_any_alpha, TraceAnyAlphaArgs, TraceClosestConstants, nearly_any_hits)       \
  STAGE(trace_wide_any_alpha, TraceWideAnyAlphaArgs, TraceWideConstants, nearly_any_hits) \
  STAGE(trace_candidates, TraceCandidatesArgs, TraceCandidatesConstants, nearly_boxes)    \
  STAGE(trace_brute_force, TraceBruteForceArgs, TraceBruteForceConstants, nearly_hits)    \
  STAGE(move_instances, MoveInstancesArgs, NoConstants, exactly)                          \
  STAGE(instance_boxes, InstanceBoxesArgs, NoConstants, exactly)                          \
  STAGE(trace_instances, TraceInstancesArgs, TraceInstancesConstants, nearly_levels)      \
  STAGE(place_hits, PlaceHitsArgs, NoConstants, exactly)                                  \
  STAGE(bounce_rays, BounceRaysArgs, NoConstants, nearly_bounced)                         \
  STAGE(texture_hits, TextureHitsArgs, NoConstants, nearly_materials)                     \
  STAGE(shade, ShadeArgs, ShadeConstants, nearly_radiance)                                \
  STAGE(shadow_marks, ShadowMarksArgs, NoConstants, exactly)                              \
  STAGE(shadow_rays, ShadowRaysArgs, NoConstants, nearly_shadow_rays)                     \
  STAGE(shade_lights, ShadeLightsArgs, ShadeLightsConstants, nearly_radiance)             \
  STAGE(occlusion_marks, OcclusionMarksArgs, NoConstants, exactly)                        \
  STAGE(occlusion_rays, OcclusionRaysArgs, NoConstants, nearly_shadow_rays)               \
  STAGE(shade_ambient, ShadeAmbientArgs, NoConstants, exactly)                            \
  STAGE(path_start, PathStartArgs, NoConstants, exactly)                                  \
  STAGE(path_fog, PathFogArgs, PathFogConstants, nearly_fog)                              \
  STAGE(path_surfaces, PathSurfacesArgs, PathSurfacesConstants, nearly_surfaces)          \
  STAGE(path_lights, PathLightsArgs, PathLightsConstants, nearly_lights)                  \
  STAGE(path_light_add, PathLightAddArgs, NoConstants, exactly)                           \
  STAGE(path_bounce, PathBounceArgs, PathBsdfConstants, nearly_marked)                    \
  STAGE(path_queue, PathQueueArgs, NoConstants, exactly)                                  \
  STAGE(show, ShowArgs, ShowConstants, nearly_radiance)                                   \
  STAGE(shade_pixels, ShadePixelsArgs, ShadeConstants, nearly_image)                      \
  STAGE(trace_pixels, TracePixelsArgs, TracePixelsConstants, nearly_pixels)               \
  STAGE(sample_add, SampleAddArgs, SampleAddConstants, exactly)                           \
  STAGE(noise_sum, NoiseSumArgs, NoiseSumConstants, nearly_noise)                         \
  STAGE(noise_marks, NoiseMarksArgs, NoConstants, nearly_marks)                           \
  STAGE(noise_pixels, NoisePixelsArgs, NoConstants, exactly)                              \
  STAGE(resolve, ResolveArgs, ResolveConstants, nearly_image)                             \
  STAGE(copy_words, CopyWordsArgs, NoConstants, exactly)                                  \
  STAGE(scan_tile_sums, ScanTileSumsArgs, NoConstants, exactly)                           \
  STAGE(prefix_scan, PrefixScanArgs, LookbackConstants, exactly)

namespace coppice {

namespace traffic {
using Bytes = std::uint64_t;
}

namespace stages {
inline constexpr std::span<const NearlySlot> exactly;
inline constexpr NearlySlot nearly_rays[] = {{"rays", Nearly::rays}};
inline constexpr NearlySlot nearly_hits[] = {{"hits", Nearly::hits}, {"counters", Nearly::counters}};
inline constexpr NearlySlot nearly_any_hits[] = {{"any_hits", Nearly::any_hits},
                                                 {"counters", Nearly::counters},
                                                 {"shadow_hits", Nearly::any_hits},
                                                 {"shadow_counters", Nearly::counters},
                                                 {"occlusion_counters", Nearly::counters}};
inline constexpr NearlySlot nearly_boxes[] = {{"candidates", Nearly::candidates},
                                              {"candidate_counts", Nearly::candidate_counts},
                                              {"counters", Nearly::counters}};
inline constexpr NearlySlot nearly_levels[] = {
    {"hits", Nearly::hits}, {"hit_instances", Nearly::hit_instances}, {"counters", Nearly::counters}};
inline constexpr NearlySlot nearly_bounced[] = {{"bounced_rays", Nearly::rays}};
inline constexpr NearlySlot nearly_shadow_rays[] = {{"shadow_rays", Nearly::rays}};
inline constexpr NearlySlot nearly_materials[] = {{"hit_materials", Nearly::radiance}};
inline constexpr NearlySlot nearly_radiance[] = {{"radiance", Nearly::radiance}};
inline constexpr NearlySlot nearly_surfaces[] = {{"radiance", Nearly::radiance},
                                                 {"surfaces", Nearly::surfaces}};
inline constexpr NearlySlot nearly_lights[] = {
    {"radiance", Nearly::radiance}, {"light_radiance", Nearly::radiance}, {"marked_rays", Nearly::rays}};
inline constexpr NearlySlot nearly_fog[] = {{"radiance", Nearly::radiance},
                                            {"light_radiance", Nearly::radiance},
                                            {"marked_rays", Nearly::rays},
                                            {"paths", Nearly::paths}};
inline constexpr NearlySlot nearly_marked[] = {{"marked_rays", Nearly::rays},
                                               {"bounced_paths", Nearly::paths}};
inline constexpr NearlySlot nearly_noise[] = {{"noise_sums", Nearly::noise}};
inline constexpr NearlySlot nearly_marks[] = {{"noise_marks", Nearly::any_hits}};
inline constexpr NearlySlot nearly_image[] = {{"image", Nearly::image}};
inline constexpr NearlySlot nearly_pixels[] = {{"image", Nearly::image}, {"counters", Nearly::counters}};
}  // namespace stages

#define COPPICE_DECLARE_STAGE(stem, Args, Constants, nearly) \
  namespace twins {                                          \
  void stem(const Args& args);                               \
  }                                                          \
  namespace traffic {                                        \
  Bytes stem(const Args& args, const RunCounts& counts);     \
  }                                                          \
  namespace stages {                                         \
  extern const Stage<Args, Constants> stem;                  \
  }
COPPICE_STAGES(COPPICE_DECLARE_STAGE)
#undef COPPICE_DECLARE_STAGE

// In the order of the table.
std::span<const StageDeclaration* const> all_stages();

}  // namespace coppice
