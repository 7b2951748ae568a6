#include "twins/trace_closest.h"

namespace coppice::twins {

void trace_closest(const TraceClosestArgs& args) { trace_closest_of(args); }

}  // namespace coppice::twins
