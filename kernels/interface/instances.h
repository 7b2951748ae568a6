// Two levels: meshes with a tree each, and instances of them with a tree over all.
#ifndef COPPICE_INTERFACE_INSTANCES_H
#define COPPICE_INTERFACE_INSTANCES_H
#include "trace.h"
INTERFACE_BEGIN

const uint MOVE_INSTANCES_GROUP = 64;
const uint INSTANCE_BOXES_GROUP = 64;
const uint NO_INSTANCE = 0xffffffffu;

// From the space of a mesh to the world, by rows: x of the world is dot(row_x, position) + move_x. The
// corners of an instance's triangles are what gather_triangles makes of the mesh's with this transform, bit
// for bit.
struct InstanceTransform {
  vec3 row_x;
  float move_x;
  vec3 row_y;
  float move_y;
  vec3 row_z;
  float move_z;
};

// Where a mesh and its tree lie among those of all meshes. Its nodes' children count from first_node, its
// leaves' triangles from first_triangle.
struct MeshRange {
  uint first_node;
  uint first_triangle;
  uint triangle_count;
  uint padding;
};

// How rays get from the world to the space of an instance's mesh: by rows, as in InstanceTransform, of some
// matrix near the inverse. A ray that meets a triangle of the instance passes through every box around it
// there once that is widened on each axis by `pad` and by `room` for each unit that the ray's origin is away
// from the instance's (maximum norm); docs/numerics.md, "Instances". Infinite pads where the transform has no
// inverse that is good for anything.
struct PlacedInstance {
  vec3 row_x;
  float room_x;  // positive
  vec3 row_y;
  float room_y;
  vec3 row_z;
  float room_z;
  vec3 pad;
  uint mesh;
};

INTERFACE_BUFFER(InstanceTransformBuffer, InstanceTransform, 16)
INTERFACE_BUFFER(MeshRangeBuffer, MeshRange, 16)
INTERFACE_BUFFER(PlacedInstanceBuffer, PlacedInstance, 16)

// Instances on their way around the axis y from where they rest, 1 to 4 laps a cycle, while each turns about
// the axis x of its mesh twice as often. At turn 0 they are where they rest, bit for bit, but that denormals
// and -0 are +0, as they are in and out of every operation.
struct MoveInstancesArgs {
  READS(InstanceTransformBuffer) rest;  // instance_count
  READS(UintBuffer) turn;               // one: the time, in parts of a whole cycle of 2^32
  InstanceTransformBuffer transforms;   // out: instance_count
  uint instance_count;
  uint seed;  // of the laps
};

struct InstanceBoxesArgs {
  READS(InstanceTransformBuffer) transforms;  // instance_count
  READS(UintBuffer) mesh_index;               // instance_count; out of range: an inactive instance
  READS(MeshRangeBuffer) meshes;              // mesh_count
  READS(BuildStateBuffer) mesh_states;        // mesh_count: those of their builds
  READS(NodeBuffer) mesh_nodes;
  PlacedInstanceBuffer placed;  // out: instance_count
  AabbBuffer boxes;             // out: instance_count; an inactive one has box_min > box_max
  TriangleBuffer corners;       // out: instance_count, triangles that have these boxes; null: not wanted
  UintBuffer mesh_height;       // out, 0 before: the greatest height of an active instance's tree
  uint instance_count;
  uint mesh_count;
};

// Closest hits through both levels; watertight and robust. A hit's triangle counts from the first one of its
// mesh. Of equally close hits the smaller instance wins, then the smaller triangle.
struct TraceInstancesArgs {
  READS(NodeBuffer) nodes;  // over the instances
  READS(NodeBuffer) mesh_nodes;
  READS(TriangleBuffer) mesh_triangles;
  READS(MeshRangeBuffer) meshes;
  READS(PlacedInstanceBuffer) placed;
  READS(InstanceTransformBuffer) transforms;
  READS(RayBuffer) rays;
  HitBuffer hits;            // ray_count; read and improved
  UintBuffer hit_instances;  // ray_count; read where there is a hit; NO_INSTANCE where nothing is hit
  TraceCountersBuffer counters;
  BuildStateBuffer state;         // of the tree over the instances
  READS(UintBuffer) mesh_height;  // with the height of that tree more than the stack: ERROR_TREE_TOO_DEEP
  UintBuffer ray_steps;           // one a ray, where the constant counts_rays says so; else null
  uint ray_count;
  uint stack_entries;
};

// What shades hits of one level shades those of two behind this: of each hit the triangle in the world and
// its material, one a ray, and in the hit the ray's index as its triangle.
struct PlaceHitsArgs {
  READS(UintBuffer) hit_instances;  // ray_count
  READS(PlacedInstanceBuffer) placed;
  READS(InstanceTransformBuffer) transforms;
  READS(MeshRangeBuffer) meshes;
  READS(TriangleBuffer) mesh_triangles;
  READS(UintBuffer) mesh_materials;  // one a triangle of mesh_triangles
  HitBuffer hits;                    // ray_count; misses stay as they are
  TriangleBuffer triangles;          // out: ray_count
  UintBuffer material_index;         // out: ray_count
  UintBuffer primitives;  // out: ray_count, the triangle in its mesh; of a miss 0; null: not wanted
  uint ray_count;
  uint padding;
};

// Specialization constants; stack_entries as in the arguments.
struct TraceInstancesConstants {
  uint max_turns;  // of the loop, as in TraceClosestConstants
  uint stack_entries;
  uint counts_rays;  // 1: the steps of each ray are kept, too
};

INTERFACE_END
#endif
