// In:  a BVH2 and rays. Out: the closest hit of each, and the pairs it visited. The height of the tree is checked against the stack.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/trace.h"

layout(push_constant, scalar) uniform Push { TraceClosestArgs args; };
#include "lib/trace_closest.glsl"
