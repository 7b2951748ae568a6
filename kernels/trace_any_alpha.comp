// In:  a BVH2, rays and what triangles let through. Out: as trace_any, whether each hits something that is there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/alpha.h"

layout(push_constant, scalar) uniform Push { TraceAnyAlphaArgs args; };
#include "lib/alpha.glsl"
#include "lib/trace_any.glsl"
