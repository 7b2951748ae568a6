#include "interface/alpha.h"
#include "twins/trace_any.h"

namespace coppice::twins {

void trace_any_alpha(const TraceAnyAlphaArgs& args) { trace_any_of(args); }

}  // namespace coppice::twins
