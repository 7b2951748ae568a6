// In:  hits of instances. Out: of each its triangle in the world and its material, at the ray's index, which becomes the
// hit's triangle: what stages of one level take. Of a miss nothing is read and zeroes are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/instances.h"
#include "interface/shade.h"
#include "lib/instance.glsl"
#include "lib/triangle_words.glsl"

layout(local_size_x = SHADE_GROUP) in;
layout(push_constant, scalar) uniform Push { PlaceHitsArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  Triangle triangle = Triangle(vec3(0.0), vec3(0.0), vec3(0.0));
  uint material = 0u;
  uint index = args.hits.at[i].triangle;
  if (uint64_t(args.primitives) != 0ul) args.primitives.at[i] = index == NO_TRIANGLE ? 0u : index;
  if (index != NO_TRIANGLE) {
    uint instance = args.hit_instances.at[i];
    uint own = args.meshes.at[args.placed.at[instance].mesh].first_triangle + index;
    Transform by = load_transform(args.transforms, instance);
    Triangle mesh = load_triangle(args.mesh_triangles, own);
    triangle = Triangle(transformed(by, mesh.a), transformed(by, mesh.b), transformed(by, mesh.c));
    material = args.mesh_materials.at[own];
    args.hits.at[i].triangle = i;
  }
  args.triangles.at[i] = triangle;
  args.material_index.at[i] = material;
}
