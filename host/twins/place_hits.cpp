#include "twins/instance.h"

namespace coppice::twins {

void place_hits(const PlaceHitsArgs& args) {
  for (uint i = 0; i < args.ray_count; ++i) {
    args.triangles[i] = {vec3(0), vec3(0), vec3(0)};
    args.material_index[i] = 0;
    const bool is_hit = args.hits[i].triangle != NO_TRIANGLE;
    if (args.primitives.value) args.primitives[i] = is_hit ? args.hits[i].triangle : 0;
    if (!is_hit) continue;
    const uint instance = args.hit_instances[i];
    const MeshRange& mesh = args.meshes[args.placed[instance].mesh];
    const std::size_t own = std::size_t{mesh.first_triangle} + args.hits[i].triangle;
    const Affine transform(args.transforms[instance]);
    const Triangle& triangle = args.mesh_triangles[own];
    args.triangles[i] = {transform(triangle.a), transform(triangle.b), transform(triangle.c)};
    args.material_index[i] = args.mesh_materials[own];
    args.hits[i].triangle = i;
  }
}

}  // namespace coppice::twins
