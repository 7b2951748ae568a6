// In:  transforms, and the trees of the meshes. Out: the box of each instance in the world, which holds its every
// corner as rounded, and what takes rays to the space of its mesh. Multiplications, additions and comparisons only. An
// instance of no mesh, of one without active triangles, or by a transform that is not finite is inactive; where a mesh
// is refitted, one without active triangles has NOTHING_BOX.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/instances.h"
#include "lib/instance.glsl"
#include "lib/node_words.glsl"

layout(local_size_x = INSTANCE_BOXES_GROUP) in;
layout(push_constant, scalar) uniform Push { InstanceBoxesArgs args; };

Aabb no_box() { return Aabb(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u))); }

void store_instance_box(uint i, Aabb box) {
  store_box(args.boxes, i, box);
  if (uint64_t(args.corners) != 0ul) args.corners.at[i] = Triangle(box.box_min, box.box_max, box.box_max);
}

// The height of its tree; 0 for an inactive one.
uint place(uint i) {
  uint mesh = args.mesh_index.at[i];
  Transform by = load_transform(args.transforms, i);
  bool is_active = mesh < args.mesh_count && finite(by);
  if (is_active) is_active = args.mesh_states.at[mesh].active_count != 0u;
  Node root;
  if (is_active) root = load_node(args.mesh_nodes, args.meshes.at[mesh].first_node);
  if (is_active) is_active = root.box_min.x <= root.box_max.x;
  if (!is_active) {
    store_instance_box(i, no_box());
    store_placed(args.placed, i,
                 PlacedInstance(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), NO_INSTANCE));
    return 0u;
  }
  Aabb box = Aabb(root.box_min, root.box_max);
  store_instance_box(i, transformed_box(by, box));
  store_placed(args.placed, i, placed_instance(by, box, mesh));
  return root.height;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint height = i < args.instance_count ? place(i) : 0u;
  uint highest = subgroupMax(height);
  if (subgroupElect() && highest != 0u) atomicMax(args.mesh_height.at[0], highest);  // partners: all other subgroups
}
