// In:  a BVH2 and rays. Out: whether each hits something, see TraceAnyArgs. The walk of trace_closest, which ends at
// the first hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"

layout(push_constant, scalar) uniform Push { TraceAnyArgs args; };
#include "lib/trace_any.glsl"
