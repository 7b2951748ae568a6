// In:  a wide tree, rays and what triangles let through. Out: the hits of trace_closest_alpha, found by packets.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/alpha.h"

layout(push_constant, scalar) uniform Push { TraceWideAlphaArgs args; };
#include "lib/alpha.glsl"
#include "lib/trace_wide.glsl"
