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

// THE TABLE. A line here, a kernel kernels/<stem>.comp and a twin host/twins/<stem>.cpp make a stage.
#define COPPICE_STAGES(STAGE)                   \
  STAGE(primitive_bounds, PrimitiveBoundsArgs)  \
  STAGE(morton_codes, MortonCodesArgs)          \
  STAGE(sort_histogram, SortHistogramArgs)      \
  STAGE(sort_digit_scan, SortDigitScanArgs)     \
  STAGE(sort_pass, SortPassArgs)                \
  STAGE(sort_tile_counts, SortScatterArgs)      \
  STAGE(sort_tile_scan, SortTileScanArgs)       \
  STAGE(sort_scatter, SortScatterArgs)          \
  STAGE(ploc_leaves, PlocLeavesArgs)            \
  STAGE(ploc_tile_counts, PlocMergeArgs)        \
  STAGE(ploc_tile_scan, PlocTileScanArgs)       \
  STAGE(ploc_merge, PlocMergeArgs)              \
  STAGE(ploc_finish, PlocFinishArgs)            \
  STAGE(hploc_build, HplocBuildArgs)            \
  STAGE(wide_root, WideCollapseArgs)            \
  STAGE(wide_collapse, WideCollapseArgs)        \
  STAGE(wide_sizes, WideSizesArgs)              \
  STAGE(wide_quantise, WideQuantiseArgs)        \
  STAGE(camera_rays, CameraRaysArgs)            \
  STAGE(trace_closest, TraceClosestArgs)        \
  STAGE(trace_wide, TraceWideArgs)              \
  STAGE(trace_wide_single, TraceWideArgs)       \
  STAGE(trace_brute_force, TraceBruteForceArgs) \
  STAGE(bounce_rays, BounceRaysArgs)            \
  STAGE(shade, ShadeArgs)                       \
  STAGE(resolve, ResolveArgs)                   \
  STAGE(copy_words, CopyWordsArgs)              \
  STAGE(scan_tile_sums, ScanTileSumsArgs)       \
  STAGE(prefix_scan, PrefixScanArgs)

namespace coppice {

#define COPPICE_DECLARE_STAGE(stem, Args) \
  namespace twins {                       \
  void stem(const Args& args);            \
  }                                       \
  namespace stages {                      \
  extern const Stage<Args> stem;          \
  }
COPPICE_STAGES(COPPICE_DECLARE_STAGE)
#undef COPPICE_DECLARE_STAGE

// In the order of the table.
std::span<const StageDeclaration* const> all_stages();

}  // namespace coppice
