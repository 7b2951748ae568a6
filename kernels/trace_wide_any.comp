// In:  a wide tree and rays. Out: whether each hits something, the same as that of trace_any. Each ray goes by itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"

layout(push_constant, scalar) uniform Push { TraceWideAnyArgs args; };
#include "lib/trace_wide_any.glsl"
