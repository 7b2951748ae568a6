// In:  a wide tree, rays and what triangles let through. Out: the words of trace_any_alpha. Each ray goes by itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/alpha.h"

layout(push_constant, scalar) uniform Push { TraceWideAnyAlphaArgs args; };
#include "lib/alpha.glsl"
#include "lib/trace_wide_any.glsl"
