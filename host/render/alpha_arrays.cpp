#include "render/alpha_arrays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "render/texture_arrays.h"
#include "scene/material_maps.h"
#include "scene/opacity.h"
#include "scene/texture.h"

namespace coppice {
namespace {

constexpr std::size_t opacity_kind = 1;
static_assert(MATERIAL_MAPS[opacity_kind].map == &Material::opacity_map);

// A channel's code; luminance is that of Rec. 709 in 256 parts, right where r, g and b are equal.
uint code_of(uint texel, uint channel) {
  const auto part = [&](uint index) { return texel >> (8 * index) & 255; };
  if (channel < CHANNEL_LUMINANCE) return part(channel);
  return (54 * part(0) + 183 * part(1) + 19 * part(2) + 128) >> 8;
}

// One channel of an image.
struct AlphaImage {
  uint first_texel = 0, width = 1, height = 1;
  uint least = 255, most = 0;
};

// What a material's triangles name: AlphaTriangle::map.
struct AlphaOfMaterial {
  uint with_texcoords = ALPHA_SOLID, without = ALPHA_SOLID;
};

class AlphaArraysMaker {
 public:
  explicit AlphaArraysMaker(const Scene& scene) : scene_(scene), listing_(list_textures(scene)) {}

  AlphaArrays make(std::span<const CornerAttributes> corners) {
    load();
    white_ = add_image({{1, 1, {0xffffffffu}}}, CHANNEL_ALPHA);
    std::vector<AlphaOfMaterial> alphas;
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) alphas.push_back(alpha_of(m));
    bool any = false;
    for (std::size_t i = 0; i < scene_.indices.size(); ++i) {
      const AlphaOfMaterial& alpha = alphas[scene_.material_index[i]];
      const uint map = (corners[i].flags & HAS_TEXCOORDS) != 0 ? alpha.with_texcoords : alpha.without;
      arrays_.triangles.push_back(
          {corners[i].texcoord_a, corners[i].texcoord_b, corners[i].texcoord_c, map, 0});
      any |= map != ALPHA_SOLID;
    }
    if (!any) return {{}, {}, {}, std::move(arrays_.warnings)};
    // Of a scene in which some triangles are nowhere there and the others are.
    if (arrays_.maps.empty()) arrays_.maps.push_back({white_.first_texel, 1, 1, 0, {}, {}, 0, 0, 0, 0});
    pack_texels();
    return std::move(arrays_);
  }

 private:
  const TextureListing::Use* use_of(std::size_t material) const {
    const std::uint32_t use = listing_.of_material[material][opacity_kind];
    return use == TextureListing::NONE ? nullptr : &listing_.uses[use];
  }

  // Of the images that are wanted, each once.
  void load() {
    std::map<std::uint32_t, std::size_t> places;
    std::vector<std::uint32_t> wanted;
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      if (use_of(m) && places.try_emplace(use_of(m)->image, wanted.size()).second)
        wanted.push_back(use_of(m)->image);
    }
    std::vector<Texture> textures(wanted.size());
    std::vector<std::string> warnings(wanted.size());
    tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t i) {
      textures[i] = load_texture(listing_.images[wanted[i]], warnings[i]);
    });
    images_.resize(scene_.materials.size());
    std::map<std::pair<std::uint32_t, uint>, AlphaImage> known;
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      if (!use_of(m)) continue;
      const std::uint32_t image = use_of(m)->image;
      const std::size_t at = places[image];
      // A checker's red has both of its colours, so that it has holes; its alpha has none.
      const uint said = opacity_channel(scene_.materials[m].opacity_map, textures[at].has_alpha);
      const uint channel = warnings[at].empty() || said == CHANNEL_ALPHA ? said : 0;
      const auto [found, is_new] = known.try_emplace({image, channel});
      if (is_new) found->second = add_wanted(textures[at], channel, listing_.images[image], warnings[at]);
      images_[m] = found->second;
    }
    for (std::string& warning : warnings) {
      if (!warning.empty()) arrays_.warnings.push_back(std::move(warning));
    }
  }

  // Or a checker in the place of one for which there is no room.
  AlphaImage add_wanted(const Texture& texture, uint channel, const TextureListing::Image& image,
                        std::string& warning) {
    if (bytes_.size() + texture.levels.front().texels.size() < MAX_TEXTURE_WORDS)
      return add_image(texture.levels, channel);
    warning = image.name + ": the scene's maps of opacity come to more than " +
              std::to_string(MAX_TEXTURE_WORDS) + " texels, a checker takes its place as " + image.user;
    return add_image(checker_texture(false).levels, 0);
  }

  AlphaImage add_image(const std::vector<Texture::Level>& levels, uint channel) {
    const Texture::Level& finest = levels.front();
    AlphaImage image{static_cast<uint>(bytes_.size()), finest.width, finest.height};
    for (const std::uint32_t texel : finest.texels) {
      const uint code = code_of(texel, channel);
      image.least = std::min(image.least, code);
      image.most = std::max(image.most, code);
      bytes_.push_back(static_cast<unsigned char>(code));
    }
    return image;
  }

  // Of an image that lies like `map`: a mask where the material has a cutoff, else coverage.
  uint add_map(const AlphaImage& image, const TextureMap& map, float coverage,
               std::optional<float> cutoff = {}) {
    const float threshold = cutoff ? *cutoff * 255 : 255 / coverage;
    const bool is_solid =
        cutoff ? static_cast<float>(image.least) >= threshold : image.least == 255 && coverage >= 1;
    const bool is_nothing =
        cutoff ? static_cast<float>(image.most) < threshold : image.most == 0 || !(coverage > 0);
    if (is_solid) return ALPHA_SOLID;
    if (is_nothing) return ALPHA_NOTHING;
    AlphaMap result{};
    result.first_texel = image.first_texel;
    result.width = image.width;
    result.height = image.height;
    result.flags = wrap_flags(map);
    result.scale = without_tiny(map.scale);
    result.offset = without_tiny(map.offset);
    result.threshold = threshold;
    result.is_coverage = !cutoff;
    arrays_.maps.push_back(result);
    return static_cast<uint>(arrays_.maps.size() - 1);
  }

  AlphaOfMaterial alpha_of(std::size_t index) {
    const Material& material = scene_.materials[index];
    const float coverage = coverage_of(material);
    if (!lets_rays_through(material)) return {};
    if (!(coverage > 0)) return {ALPHA_NOTHING, ALPHA_NOTHING};
    const uint without = add_map(white_, {}, coverage, material.alpha_cutoff);
    if (!use_of(index)) return {without, without};
    return {add_map(images_[index], use_of(index)->map, coverage, material.alpha_cutoff), without};
  }

  void pack_texels() {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, 255);
    for (std::size_t i = 0; i < bytes_.size(); i += 4) {
      uint word = 0;
      for (std::size_t k = 0; k < 4; ++k) word |= uint{bytes_[i + k]} << (8 * k);
      arrays_.texels.push_back(word);
    }
  }

  const Scene& scene_;
  TextureListing listing_;
  std::vector<AlphaImage> images_;  // of each material that has a map
  AlphaImage white_;
  std::vector<unsigned char> bytes_;
  AlphaArrays arrays_;
};

}  // namespace

AlphaArrays alpha_arrays(const Scene& scene, std::span<const CornerAttributes> corners) {
  return AlphaArraysMaker(scene).make(corners);
}

}  // namespace coppice
