// In:  keys. Out: how often each digit of this pass occurs in each tile.
// Merrill and Grimshaw 2011, "High Performance and Scalable Radix Sorting", section 4.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/sort.h"

layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(push_constant, scalar) uniform Push { SortScatterArgs args; };

#include "lib/subgroup_match.glsl"
#include "lib/device_count.glsl"
#include "lib/sort_counters.glsl"

void main() {
  uvec2 places = places_of_tile();
  if (places.y == 0u) return;
  count_tile(places);
  store_counters();
}
