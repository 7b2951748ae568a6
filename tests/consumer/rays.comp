// Given rays through both kinds of trees from a shader that is none of Coppice's: what traverse.glsl finds.
#version 460
#extension GL_GOOGLE_include_directive : require
#define COPPICE_STACK 128
#include "coppice/traverse.glsl"

layout(local_size_x = 32) in;

layout(push_constant, scalar) uniform Push {
  CoppiceTree tree;
  WideNodeBuffer wide_nodes;
  WideCountsBuffer wide_counts;
  RayBuffer rays;
  HitBuffer hits;       // two a ray: of the tree, and of the wide one
  UintBuffer any_hits;  // likewise; 2 where the tree does not fit
  uint ray_count;
  uint mask;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= ray_count) return;
  CoppiceWideTree wide = CoppiceWideTree(wide_nodes, wide_counts, tree.nodes, tree.triangles, tree.primitive_flags);
  hits.at[2u * i] = coppice_trace_closest(tree, rays.at[i], mask);
  hits.at[2u * i + 1u] = coppice_trace_closest(wide, rays.at[i], mask);
  any_hits.at[2u * i] = coppice_fits(tree) ? (coppice_trace_any(tree, rays.at[i], mask) ? 1u : 0u) : 2u;
  any_hits.at[2u * i + 1u] = coppice_trace_any(wide, rays.at[i], mask) ? 1u : 0u;
}
