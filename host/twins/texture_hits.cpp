#include "interface/texture_hits.h"

#include <algorithm>
#include <cmath>

#include "twins/texture.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

class HitTextures {
 public:
  HitTextures(const TextureHitsArgs& args, const Hit& hit, const vec3& direction) : args_(args) {
    const CornerAttributes& corners = args.corners[hit.triangle];
    has_place_ = (corners.flags & HAS_TEXCOORDS) != 0;
    if (!has_place_) return;
    const float w = 1.0f - hit.u - hit.v;
    place_ = corners.texcoord_a * w + corners.texcoord_b * hit.u + corners.texcoord_c * hit.v;
    const Triangle& triangle = args.triangles[hit.triangle];
    const vec3& row = args.film[0].down;
    const float cone = cone_width_at(0, std::sqrt(dot_product(row, row)), hit.t);
    const float cosine = std::fabs(dot_product(unit_normal(triangle), unit_vector(direction)));
    level_ = surface_level(twice_texcoord_area(corners), twice_area(triangle), cone, cosine);
  }

  vec3 colour_of(uint map) const {
    if (map == TEXTURE_NONE || !has_place_) return vec3(1);
    return vec3(texture_colour(args_.headers, args_.texels, args_.srgb_to_linear, map, place_,
                               level_ + texture_level(args_.headers[map])));
  }

 private:
  const TextureHitsArgs& args_;
  bool has_place_ = false;
  vec2 place_{0};
  float level_ = 0;
};

}  // namespace

void texture_hits(const TextureHitsArgs& args) {
  const uint count = args.count_at.value != 0 ? std::min(args.count_at[0], args.ray_count) : args.ray_count;
  for (uint i = 0; i < count; ++i) {
    const Hit hit = args.hits[i];
    if (hit.triangle == NO_TRIANGLE) continue;
    const uint which = args.material_index[hit.triangle];
    const TexturedMaterial& material = args.materials[which];
    const HitTextures textures(args, hit, args.rays[i].direction);
    const vec3 base = textures.colour_of(args.maps[which].diffuse);
    args.hit_materials[i].ambient =
        material.emission * textures.colour_of(args.maps[which].emission) + material.ambient * base;
    args.hit_materials[i].diffuse = material.diffuse * base;
  }
}

}  // namespace coppice::twins
