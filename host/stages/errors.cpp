#include "stages/errors.h"

#include "interface/types.h"

namespace coppice {

std::string describe_error_word(std::uint32_t error_word) {
  constexpr struct {
    std::uint32_t bit;
    const char* meaning;
  } errors[] = {
      {ERROR_SORT_LOOKBACK,
       "sort_pass: a tile waited in vain for the sums of the tiles before it (--lookback off does without)"},
      {ERROR_PLOC_LOOKBACK,
       "ploc_merge: a tile waited in vain for the sums of the tiles before it (--lookback off does without)"},
      {ERROR_SCAN_LOOKBACK,
       "prefix_scan: a tile waited in vain for the sums of the tiles before it (--lookback off does "
       "without)"},
      {ERROR_PLOC_ROUNDS,
       "ploc_finish or batch_build: the rounds did not end with one cluster within their bound"},
      {ERROR_TREE_TOO_DEEP,
       "trace_closest, trace_any, trace_candidates or trace_instances: the tree is deeper than the traversal "
       "stack"},
      {ERROR_TRACE_STEPS,
       "trace_closest, trace_wide, trace_wide_single, trace_pixels, trace_any, trace_wide_any, "
       "trace_candidates "
       "or trace_instances: a ray needs more steps than this driver's loops may take"},
      {ERROR_COUNT,
       "primitive_bounds, box_bounds, sort_pass, sort_scatter, prefix_scan or batch_build: the count on the "
       "device is larger than "
       "what was "
       "planned for"},
      {ERROR_BATCH_RANGE,
       "batch_build: a range has more primitives than a tree of a batch, or lies beyond the last of them"},
      {ERROR_RAY_COUNT, "a trace: the count of rays on the device is larger than what was planned for"},
      {ERROR_WIDE_TOO_DEEP, "wide_root: the tree is deeper than the conversion to wide nodes takes"},
      {ERROR_REFIT_TOO_DEEP, "refit_keys: the tree is deeper than a refit takes"},
  };
  std::string description;
  const auto add = [&](const char* meaning) {
    if (!description.empty()) description.append("; ");
    description.append(meaning);
  };
  for (const auto& error : errors) {
    if (error_word & error.bit) add(error.meaning);
    error_word &= ~error.bit;
  }
  if (error_word) add("error bits that no stage knows");
  return description;
}

}  // namespace coppice
