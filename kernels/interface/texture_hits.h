// Materials of hits, with what their textures have there.
#ifndef COPPICE_INTERFACE_TEXTURE_HITS_H
#define COPPICE_INTERFACE_TEXTURE_HITS_H
#include "shade.h"
#include "texture.h"
INTERFACE_BEGIN

const uint TEXTURE_HITS_GROUP = 64;

// A SurfaceMaterial before its maps are multiplied in.
struct TexturedMaterial {
  vec3 emission;
  vec3 ambient;  // diffuse colour times the ambient light
  vec3 diffuse;  // as in SurfaceMaterial
};

INTERFACE_BUFFER(TexturedMaterialBuffer, TexturedMaterial, 4)

// Of each hit its material: emission times the emission map plus ambient times the diffuse map; diffuse times
// the diffuse map. A triangle without texture coordinates is as without maps. Textures are read at the level
// that the distance between pixels asks for, at the hit and turned as the surface is. Nothing is written of a
// miss.
struct TextureHitsArgs {
  READS(FilmBuffer) film;
  READS(TriangleBuffer) triangles;
  READS(UintBuffer) material_index;         // one a triangle
  READS(TexturedMaterialBuffer) materials;  // one a material
  READS(MaterialTexturesBuffer) maps;       // one a material
  READS(TextureHeaderBuffer) headers;       // of all textures
  READS(UintBuffer) texels;
  READS(FloatBuffer) srgb_to_linear;      // 256
  READS(CornerAttributesBuffer) corners;  // one a triangle
  READS(RayBuffer) rays;                  // ray_count
  READS(HitBuffer) hits;                  // ray_count
  SurfaceMaterialBuffer hit_materials;    // out, ray_count
  READS(UintBuffer) count_at;             // as in TraceClosestArgs
  uint ray_count;
  uint padding;
};

INTERFACE_END
#endif
