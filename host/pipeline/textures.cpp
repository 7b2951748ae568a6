#include "pipeline/textures.h"

#include "stages/stages.h"

namespace coppice {

TextureSlots plan_textures(Layout& layout, const TextureCounts& counts, std::uint32_t triangle_count,
                           std::uint32_t material_count, std::uint32_t band_rays) {
  TextureSlots slots;
  if (counts.textures == 0) return slots;
  slots.materials = layout.add<TexturedMaterial>("textured_materials", material_count);
  slots.maps = layout.add<MaterialTextures>("material_maps", material_count);
  slots.headers = layout.add<TextureHeader>("texture_headers", counts.textures);
  slots.texels = layout.add<uint>("texels", counts.texels);
  slots.srgb_to_linear = layout.add<float>("srgb_to_linear", 256);
  slots.corners = layout.add<CornerAttributes>("corners", triangle_count);
  slots.hit_materials = layout.add<SurfaceMaterial>("hit_materials", band_rays);
  return slots;
}

void append_textures(Chain& chain, const TextureSlots& slots, const TexturedRays& rays) {
  chain.run(stages::texture_hits,
            {rays.film, rays.triangles, rays.material_index, chain.at(slots.materials), chain.at(slots.maps),
             chain.at(slots.headers), chain.at(slots.texels), chain.at(slots.srgb_to_linear),
             chain.at(slots.corners), rays.rays, rays.hits, rays.hit_materials, rays.count_at, rays.count, 0},
            groups_of(rays.count, TEXTURE_HITS_GROUP));
}

}  // namespace coppice
