#include <cmath>
#include <memory>

#include "scene/input_error.h"
#include "scene/printable.h"
#include "scene/texture.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>

namespace coppice {

Texture decode_texture(std::string_view bytes, bool is_colour) {
  static_assert(MAX_IMAGE_SIDE == STBI_MAX_DIMENSIONS);
  if (bytes.size() > 0x7fffffff) {
    throw InputError(std::to_string(bytes.size()) + " bytes, expected an image of less than 2 GiB");
  }
  const auto* const begin = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  const auto fail = [] {
    const char* const reason = stbi_failure_reason();
    throw InputError("no PNG, JPEG, TGA or BMP that can be read (" +
                     std::string(reason ? reason : "unknown") + ")");
  };
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(begin, size, &width, &height, &channels)) fail();
  constexpr auto most = static_cast<int>(MAX_IMAGE_SIDE);
  if (width < 1 || height < 1 || width > most || height > most) {
    throw InputError(std::to_string(width) + " by " + std::to_string(height) +
                     " texels, expected from 1 to " + std::to_string(most) + " a side");
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> image(
      stbi_load_from_memory(begin, size, &width, &height, &channels, 4), stbi_image_free);
  if (!image) fail();
  Texture texture;
  texture.is_colour = is_colour;
  Texture::Level& level = texture.levels.emplace_back();
  level.width = static_cast<std::uint32_t>(width);
  level.height = static_cast<std::uint32_t>(height);
  level.texels.resize(std::size_t{level.width} * level.height);
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    const stbi_uc* const rgba = image.get() + 4 * i;
    level.texels[i] = std::uint32_t{rgba[0]} | std::uint32_t{rgba[1]} << 8 | std::uint32_t{rgba[2]} << 16 |
                      std::uint32_t{rgba[3]} << 24;
    texture.has_alpha |= rgba[3] != 255;
  }
  make_mip_levels(texture);
  return texture;
}

bool has_alpha_channel(std::string_view bytes) {
  int width = 0, height = 0, channels = 0;
  return bytes.size() <= 0x7fffffff &&
         stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                               &width, &height, &channels) != 0 &&
         channels % 2 == 0;
}

}  // namespace coppice
