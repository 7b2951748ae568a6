// What a picture shows in place of colours.
#ifndef COPPICE_INTERFACE_SHOW_H
#define COPPICE_INTERFACE_SHOW_H
#include "trace.h"
INTERFACE_BEGIN

const uint SHOW_GROUP = 64;

const uint SHOW_COLOR = 0;      // what shade makes; none of the others
const uint SHOW_STEPS = 1;      // nodes that the ray visited, through the map; rays without a hit, too
const uint SHOW_NORMALS = 2;    // of triangles, as their corners go round: 0.5 + 0.5 n, squared
const uint SHOW_DEPTH = 3;      // along the line of sight, through the map
const uint SHOW_IDS = 4;        // of primitives, a colour each
const uint SHOW_RANKS = 5;      // the word of the primitive, through the map
const uint SHOW_GROUPS = 6;     // the word of the primitive, a colour each
const uint SHOW_INSTANCES = 7;  // a colour each; one for all where there are none
// Of two levels the primitives of SHOW_RANKS and SHOW_GROUPS are instances, and SHOW_IDS tells triangles of
// other instances apart.
const uint SHOW_INSTANCE_STRIDE = 2654435761u;  // of the numbers of triangles from instance to instance

const uint SHOW_MAP_COLOURS = 256;
const float SHOW_NOTHING = 0.0078125;  // each channel, where nothing is hit

// A value v has colour (v - least) * per_unit of the map, rounded down, the first or last one beyond its
// ends.
struct ShowScale {
  float least;
  float per_unit;
  uint padding0, padding1;
};

// Of the values of SHOW_STEPS, as integers, and SHOW_DEPTH, as bits of floats that are not negative. Zero
// before; both are maxima, so that they do not depend on the order in which rays come.
struct ShowRange {
  uint least_complement;
  uint greatest;
  uint padding0, padding1;
};

INTERFACE_BUFFER(ShowScaleBuffer, ShowScale, 16)
INTERFACE_BUFFER(ShowRangeBuffer, ShowRange, 16)

struct ShowArgs {
  READS(TriangleBuffer) triangles;
  READS(HitBuffer) hits;
  READS(UintBuffer) ray_steps;         // one a ray; SHOW_STEPS only, else null
  READS(UintBuffer) primitive_values;  // one a primitive; SHOW_RANKS and SHOW_GROUPS only
  READS(UintBuffer) hit_instances;     // one a ray; null: one level
  READS(UintBuffer) hit_primitives;    // one a ray; SHOW_IDS of two levels only, else null
  READS(Vec3Buffer) colour_map;        // SHOW_MAP_COLOURS, linear RGB
  READS(ShowScaleBuffer) scale;
  ShowRangeBuffer range;
  Vec3Buffer radiance;  // ray_count; summed over the samples
  uint ray_count;
  uint sample_index;
  uint view;  // SHOW_
  uint padding;
};

struct ShowConstants {
  uint view;  // as in the arguments
};

INTERFACE_END
#endif
