#include "render/texture_arrays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene/material_maps.h"
#include "scene/printable.h"
#include "scene/texture.h"

namespace coppice {
namespace {

static_assert(MAX_TEXTURE_SIDE == MAX_IMAGE_SIDE);
static_assert(static_cast<uint>(TextureWrap::repeat) == TEXTURE_REPEAT &&
              static_cast<uint>(TextureWrap::clamp) == TEXTURE_CLAMP &&
              static_cast<uint>(TextureWrap::mirror) == TEXTURE_MIRROR);

float large_or_zero(float x) { return std::abs(x) < 0x1p-60f ? 0.0f : x; }

std::size_t words_of(const Texture& texture) {
  std::size_t words = 0;
  for (const Texture::Level& level : texture.levels) words += level.texels.size();
  return words;
}

uint channel_of(const TextureMap& map, bool has_alpha, bool is_opacity) {
  const std::size_t named = std::string_view("rgbml").find(map.channel);
  if (map.channel != 0 && named < 5) return static_cast<uint>(named);
  return is_opacity && has_alpha ? CHANNEL_ALPHA : CHANNEL_LUMINANCE;
}

class TextureArraysMaker {
 public:
  explicit TextureArraysMaker(const Scene& scene) : scene_(scene), listing_(list_textures(scene)) {}

  TextureArrays make() {
    load();
    add_headers();
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) add_material(m);
    const std::array<float, 256> linear = srgb_to_linear();
    if (!listing_.images.empty()) arrays_.srgb_to_linear.assign(linear.begin(), linear.end());
    return std::move(arrays_);
  }

 private:
  void load() {
    const std::size_t count = listing_.images.size();
    std::vector<Texture> textures(count);
    std::vector<std::string> warnings(count);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { textures[i] = load_texture(listing_.images[i], warnings[i]); });
    images_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (arrays_.texels.size() + words_of(textures[i]) > MAX_TEXTURE_WORDS) {
        warnings[i] = printable(std::string_view(listing_.images[i].name)) +
                      ": the scene's textures come to more than " + std::to_string(MAX_TEXTURE_WORDS) +
                      " texels, a checker takes its place as " + listing_.images[i].user;
        textures[i] = checker_texture(listing_.images[i].is_colour);
      }
      if (!warnings[i].empty()) arrays_.warnings.push_back(std::move(warnings[i]));
      const Texture::Level& finest = textures[i].levels.front();
      images_[i] = {static_cast<uint>(arrays_.texels.size()), finest.width, finest.height,
                    static_cast<uint>(textures[i].levels.size()), textures[i].has_alpha};
      for (const Texture::Level& level : textures[i].levels) {
        arrays_.texels.insert(arrays_.texels.end(), level.texels.begin(), level.texels.end());
      }
      textures[i] = {};
    }
  }

  void add_headers() {
    for (const TextureListing::Use& use : listing_.uses) {
      const LoadedImage& image = images_[use.image];
      TextureHeader header{};
      header.first_word = image.first_word;
      header.width = image.width;
      header.height = image.height;
      header.levels = image.levels;
      header.scale = without_tiny(use.map.scale);
      header.offset = without_tiny(use.map.offset);
      header.flags = wrap_flags(use.map) | (use.is_colour ? TEXTURE_COLOUR : 0u);
      arrays_.headers.push_back(header);
    }
  }

  void add_material(std::size_t index) {
    const Material& material = scene_.materials[index];
    const auto& maps = listing_.of_material[index];
    const auto channel = [&](std::size_t kind, bool is_opacity) {
      const bool has_alpha = maps[kind] != TEXTURE_NONE && images_[listing_.uses[maps[kind]].image].has_alpha;
      return channel_of(material.*MATERIAL_MAPS[kind].map, has_alpha, is_opacity);
    };
    MaterialTextures textures{};
    uint* const members[] = {&textures.diffuse, &textures.opacity,   &textures.emission, &textures.bump,
                             &textures.normal,  &textures.roughness, &textures.metallic};
    for (std::size_t kind = 0; kind < maps.size(); ++kind) *members[kind] = maps[kind];
    textures.channels = channel(1, true) << OPACITY_CHANNEL_SHIFT | channel(3, false) << BUMP_CHANNEL_SHIFT |
                        channel(5, false) << ROUGHNESS_CHANNEL_SHIFT |
                        channel(6, false) << METALLIC_CHANNEL_SHIFT;
    textures.strength = material.normal_map ? material.normal_map.strength : material.bump_map.strength;
    textures.alpha_cutoff = material.alpha_cutoff.value_or(-1.0f);
    arrays_.materials.push_back(textures);
  }

  struct LoadedImage {
    uint first_word = 0, width = 0, height = 0, levels = 0;
    bool has_alpha = false;
  };

  const Scene& scene_;
  TextureListing listing_;
  std::vector<LoadedImage> images_;
  TextureArrays arrays_;
};

// Unit length; zero where it has none.
vec3 unit_normal_of(vec3 normal) {
  const glm::dvec3 exact(normal);
  const double length = glm::length(exact);
  if (!(length > 0) || !std::isfinite(length)) return vec3(0);
  const vec3 unit(exact / length);
  return {large_or_zero(unit.x), large_or_zero(unit.y), large_or_zero(unit.z)};
}

void add_texcoords(const Scene& scene, std::size_t triangle, CornerAttributes& corners) {
  const uvec3 index = scene.texcoord_index[triangle];
  if (index.x == NO_ATTRIBUTE || index.y == NO_ATTRIBUTE || index.z == NO_ATTRIBUTE) return;
  corners.texcoord_a = without_tiny(scene.texcoords[index.x]);
  corners.texcoord_b = without_tiny(scene.texcoords[index.y]);
  corners.texcoord_c = without_tiny(scene.texcoords[index.z]);
  corners.flags |= HAS_TEXCOORDS;
}

void add_normals(const Scene& scene, std::size_t triangle, CornerAttributes& corners) {
  const uvec3 index = scene.normal_index[triangle];
  if (index.x == NO_ATTRIBUTE || index.y == NO_ATTRIBUTE || index.z == NO_ATTRIBUTE) return;
  const vec3 a = unit_normal_of(scene.normals[index.x]), b = unit_normal_of(scene.normals[index.y]),
             c = unit_normal_of(scene.normals[index.z]);
  if (a == vec3(0) || b == vec3(0) || c == vec3(0)) return;
  corners.normal_a = a;
  corners.normal_b = b;
  corners.normal_c = c;
  corners.flags |= HAS_NORMALS;
}

}  // namespace

vec2 without_tiny(vec2 v) { return {large_or_zero(v.x), large_or_zero(v.y)}; }

uint wrap_flags(const TextureMap& map) {
  return static_cast<uint>(map.wrap_u) << TEXTURE_WRAP_U_SHIFT | static_cast<uint>(map.wrap_v)
                                                                     << TEXTURE_WRAP_V_SHIFT;
}

uint opacity_channel(const TextureMap& map, bool has_alpha) { return channel_of(map, has_alpha, true); }

TextureArrays texture_arrays(const Scene& scene) { return TextureArraysMaker(scene).make(); }

std::vector<CornerAttributes> corner_attributes(const Scene& scene) {
  std::vector<CornerAttributes> all(scene.indices.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    if (!scene.texcoord_index.empty()) add_texcoords(scene, i, all[i]);
    if (!scene.normal_index.empty()) add_normals(scene, i, all[i]);
  });
  return all;
}

}  // namespace coppice
