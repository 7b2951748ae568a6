#include "interface/alpha.h"
#include "twins/trace_closest.h"

namespace coppice::twins {

void trace_closest_alpha(const TraceClosestAlphaArgs& args) { trace_closest_of(args); }

}  // namespace coppice::twins
