// In:  a wide tree and rays. Out: the closest hit of each, the same as that of trace_closest, found by packets
// (lib/wide_packet.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"

layout(push_constant, scalar) uniform Push { TraceWideArgs args; };
#include "lib/trace_wide.glsl"
