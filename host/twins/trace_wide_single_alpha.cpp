#include "interface/alpha.h"
#include "twins/trace_wide_single.h"

namespace coppice::twins {

void trace_wide_single_alpha(const TraceWideAlphaArgs& args) { trace_wide_single_of(args); }

}  // namespace coppice::twins
