#include "twins/trace_wide_any.h"

namespace coppice::twins {

void trace_wide_any(const TraceWideAnyArgs& args) { trace_wide_any_of(args); }

}  // namespace coppice::twins
