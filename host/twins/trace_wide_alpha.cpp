#include "interface/alpha.h"
#include "twins/trace_wide.h"

namespace coppice::twins {

void trace_wide_alpha(const TraceWideAlphaArgs& args) { trace_wide_of(args); }

}  // namespace coppice::twins
