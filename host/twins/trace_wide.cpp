#include "twins/trace_wide.h"

namespace coppice::twins {

void trace_wide(const TraceWideArgs& args) { trace_wide_of(args); }

}  // namespace coppice::twins
