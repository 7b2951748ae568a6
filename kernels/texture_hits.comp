// In:  hits and textures. Out: of each hit its material, see TextureHitsArgs. Ray cones as in lib/texture_level.glsl; of
// a pinhole camera the cone of a pixel is t times the distance of two rows of pixels wide, whatever the length of the
// ray's direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface/texture_hits.h"
#include "lib/device_count.glsl"
#include "lib/exact_vector.glsl"
#include "lib/ray_words.glsl"
#include "lib/texture.glsl"
#include "lib/texture_level.glsl"

layout(local_size_x = TEXTURE_HITS_GROUP) in;
layout(push_constant, scalar) uniform Push { TextureHitsArgs args; };

vec2 texcoord_at(CornerAttributes corners, Hit hit) {
  precise float w = 1.0 - hit.u - hit.v;
  precise vec2 uv = corners.texcoord_a * w + corners.texcoord_b * hit.u + corners.texcoord_c * hit.v;
  return uv;
}

float level_at(CornerAttributes corners, Hit hit, vec3 direction) {
  Triangle triangle = args.triangles.at[hit.triangle];
  vec3 down = args.film.at[0].down;
  float width = cone_width_at(0.0, sqrt(exact_dot(down, down)), hit.t);
  float cosine = abs(exact_dot(normal_of(triangle), unit(direction)));
  return surface_level(twice_texcoord_area(corners), twice_area(triangle), width, cosine);
}

vec3 map_colour(uint map, vec2 uv, float level) {
  if (map == TEXTURE_NONE) return vec3(1.0);
  precise float own_level = level + texture_level(args.headers.at[map]);
  return texture_colour(args.headers, args.texels, args.srgb_to_linear, map, uv, own_level).rgb;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= counted(args.count_at, args.ray_count)) return;
  Hit hit = load_hit(args.hits, i);
  if (hit.triangle == NO_TRIANGLE) return;
  uint which = args.material_index.at[hit.triangle];
  uint diffuse_map = args.maps.at[which].diffuse, emission_map = args.maps.at[which].emission;
  vec3 diffuse = vec3(1.0), emission = vec3(1.0);
  CornerAttributes corners = args.corners.at[hit.triangle];
  bool has_maps = (diffuse_map & emission_map) != TEXTURE_NONE;  // one at least
  if (has_maps && (corners.flags & HAS_TEXCOORDS) != 0u) {
    vec2 uv = texcoord_at(corners, hit);
    float level = level_at(corners, hit, args.rays.at[i].direction);
    diffuse = map_colour(diffuse_map, uv, level);
    emission = map_colour(emission_map, uv, level);
  }
  TexturedMaterial material = args.materials.at[which];
  precise vec3 ambient = material.emission * emission + material.ambient * diffuse;
  precise vec3 reflected = material.diffuse * diffuse;
  args.hit_materials.at[i] = SurfaceMaterial(ambient, reflected);
}
