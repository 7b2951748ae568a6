#pragma once

#include <cstdint>

#include "interface/texture_hits.h"
#include "pipeline/build_plan.h"

namespace coppice {

// Of a scene whose hits are textured; no textures: none are.
struct TextureCounts {
  std::uint32_t textures = 0;
  std::uint64_t texels = 0;

  bool operator==(const TextureCounts&) const = default;
};

// What texture_hits takes and leaves; all empty where there are no textures.
struct TextureSlots {
  Slot<TexturedMaterial> materials;     // in
  Slot<MaterialTextures> maps;          // in
  Slot<TextureHeader> headers;          // in
  Slot<uint> texels;                    // in
  Slot<float> srgb_to_linear;           // in
  Slot<CornerAttributes> corners;       // in
  Slot<SurfaceMaterial> hit_materials;  // one a ray of a band
};

// Throws LayoutError if a slot does not fit a block.
TextureSlots plan_textures(Layout& layout, const TextureCounts& counts, std::uint32_t triangle_count,
                           std::uint32_t material_count, std::uint32_t band_rays);

// Rays, what they have hit, and what hits name.
struct TexturedRays {
  FilmBuffer film;
  TriangleBuffer triangles;
  UintBuffer material_index;
  RayBuffer rays;
  HitBuffer hits;
  SurfaceMaterialBuffer hit_materials;  // out
  UintBuffer count_at;                  // null: all `count` rays
  std::uint32_t count;
};

// The material of each hit.
void append_textures(Chain& chain, const TextureSlots& slots, const TexturedRays& rays);

}  // namespace coppice
