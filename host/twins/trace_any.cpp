#include "twins/trace_any.h"

namespace coppice::twins {

void trace_any(const TraceAnyArgs& args) { trace_any_of(args); }

}  // namespace coppice::twins
