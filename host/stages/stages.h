#pragma once

#include "interface/bounds.h"
#include "interface/copy.h"
#include "interface/hploc.h"
#include "interface/morton.h"
#include "interface/ploc.h"
#include "interface/scan.h"
#include "interface/sort.h"
#include "interface/trace.h"
#include "interface/wide.h"
#include "stages/stage.h"

// THE TABLE. A line here, a kernel kernels/<stem>.comp and a twin host/twins/<stem>.cpp make a stage. The
// third word says what of its result only nearly equals the twin's on a GPU, see below.
#define COPPICE_STAGES(STAGE)                                \
  STAGE(primitive_bounds, PrimitiveBoundsArgs, exactly)      \
  STAGE(morton_codes, MortonCodesArgs, exactly)              \
  STAGE(sort_histogram, SortHistogramArgs, exactly)          \
  STAGE(sort_digit_scan, SortDigitScanArgs, exactly)         \
  STAGE(sort_pass, SortPassArgs, exactly)                    \
  STAGE(sort_tile_counts, SortScatterArgs, exactly)          \
  STAGE(sort_tile_scan, SortTileScanArgs, exactly)           \
  STAGE(sort_scatter, SortScatterArgs, exactly)              \
  STAGE(ploc_leaves, PlocLeavesArgs, exactly)                \
  STAGE(ploc_tile_counts, PlocMergeArgs, exactly)            \
  STAGE(ploc_tile_scan, PlocTileScanArgs, exactly)           \
  STAGE(ploc_merge, PlocMergeArgs, exactly)                  \
  STAGE(ploc_finish, PlocFinishArgs, exactly)                \
  STAGE(hploc_build, HplocBuildArgs, exactly)                \
  STAGE(wide_root, WideCollapseArgs, exactly)                \
  STAGE(wide_collapse, WideCollapseArgs, exactly)            \
  STAGE(wide_sizes, WideSizesArgs, exactly)                  \
  STAGE(wide_quantise, WideQuantiseArgs, exactly)            \
  STAGE(camera_rays, CameraRaysArgs, nearly_rays)            \
  STAGE(trace_closest, TraceClosestArgs, nearly_hits)        \
  STAGE(trace_wide, TraceWideArgs, nearly_hits)              \
  STAGE(trace_wide_single, TraceWideArgs, nearly_hits)       \
  STAGE(trace_brute_force, TraceBruteForceArgs, nearly_hits) \
  STAGE(bounce_rays, BounceRaysArgs, nearly_bounced)         \
  STAGE(shade, ShadeArgs, nearly_radiance)                   \
  STAGE(resolve, ResolveArgs, nearly_image)                  \
  STAGE(copy_words, CopyWordsArgs, exactly)                  \
  STAGE(scan_tile_sums, ScanTileSumsArgs, exactly)           \
  STAGE(prefix_scan, PrefixScanArgs, exactly)

namespace coppice {

namespace stages {
inline constexpr std::span<const NearlySlot> exactly;
inline constexpr NearlySlot nearly_rays[] = {{"rays", Nearly::rays}};
inline constexpr NearlySlot nearly_hits[] = {{"hits", Nearly::hits}, {"counters", Nearly::counters}};
inline constexpr NearlySlot nearly_bounced[] = {{"bounced_rays", Nearly::rays}};
inline constexpr NearlySlot nearly_radiance[] = {{"radiance", Nearly::radiance}};
inline constexpr NearlySlot nearly_image[] = {{"image", Nearly::image}};
}  // namespace stages

#define COPPICE_DECLARE_STAGE(stem, Args, nearly) \
  namespace twins {                               \
  void stem(const Args& args);                    \
  }                                               \
  namespace stages {                              \
  extern const Stage<Args> stem;                  \
  }
COPPICE_STAGES(COPPICE_DECLARE_STAGE)
#undef COPPICE_DECLARE_STAGE

// In the order of the table.
std::span<const StageDeclaration* const> all_stages();

}  // namespace coppice
