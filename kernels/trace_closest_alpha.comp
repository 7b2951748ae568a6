// In:  a BVH2, rays and what triangles let through. Out: as trace_closest, the closest hit on what is there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/alpha.h"

layout(push_constant, scalar) uniform Push { TraceClosestAlphaArgs args; };
#include "lib/alpha.glsl"
#include "lib/trace_closest.glsl"
