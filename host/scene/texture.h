#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// A decoded image with its mip levels.
struct Texture {
  struct Level {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> texels;  // rows from the top; r in the lowest byte, then g, b and a
  };
  std::vector<Level> levels;  // the finest first, each of half the sides, rounded down, the last 1 by 1
  bool is_colour = false;     // r, g and b are sRGB codes; else, as alpha always, parts of 255
  bool has_alpha = false;     // any texel's is not 255
};

inline constexpr std::uint32_t MAX_IMAGE_SIDE = 16384;

// The linear value of each sRGB code (IEC 61966-2-1).
std::array<float, 256> srgb_to_linear();

// Of the bytes of a PNG, JPEG, TGA or BMP file. Throws InputError, with what is wrong and not where.
Texture decode_texture(std::string_view bytes, bool is_colour);

// Whether the image may have alpha, as its header says it; false of what is no image.
bool has_alpha_channel(std::string_view bytes);

// From its finest level on: a box filter on linear values, in which an odd number of texels 2n + 1 becomes n,
// each of exactly the stretch it covers.
void make_mip_levels(Texture& texture);

// What takes the place of a texture that is missing or broken: 8 by 8 squares of magenta and black.
Texture checker_texture(bool is_colour);

// The textures of a scene's materials, each once.
struct TextureListing {
  static constexpr std::uint32_t NONE = ~0u;
  struct Use {
    TextureMap map;
    bool is_colour = false;
    std::uint32_t image = 0;
  };
  struct Image {
    std::string name, folder;
    std::shared_ptr<const std::string> bytes;
    bool is_colour = false;
    std::string user;  // the first of it, as a message names it
  };
  std::vector<Use> uses;      // images as they lie on surfaces
  std::vector<Image> images;  // to decode
  // Of each material and each of MATERIAL_MAPS: into uses, or NONE. Materials that no triangle has have none.
  std::vector<std::array<std::uint32_t, 7>> of_material;
};
TextureListing list_textures(const Scene& scene);

// The image, decoded; a checker and a line in `warning` where there is none. A file is also found in other
// letter case, with \ for /, and by its bare name in the folder.
Texture load_texture(const TextureListing::Image& image, std::string& warning);

// Materials whose map of colours may cut out, and is a cut-out, get its alpha as their map of opacity. One
// with a map of opacity keeps that. A cut-out has texels whose alpha is below 16 and from 240 on, of each a
// hundredth at least, and three in four are one of both; alpha that means something else rarely looks so. Of
// used materials images with alpha are decoded, all others' headers are read.
void find_cut_outs(Scene& scene);

}  // namespace coppice
