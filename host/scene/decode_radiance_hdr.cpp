// A source of its own, as decode_texture.cpp has the same library for other formats.
#include <cstring>
#include <memory>

#include "scene/environment.h"
#include "scene/input_error.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>

namespace coppice {

RadianceImage decode_radiance_hdr(std::string_view bytes) {
  static_assert(MAX_RADIANCE_SIDE == STBI_MAX_DIMENSIONS);
  if (bytes.size() > 0x7fffffff)
    throw InputError(std::to_string(bytes.size()) + " bytes, expected an image of less than 2 GiB");
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<float, void (*)(void*)> image(
      stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                             &width, &height, &channels, 3),
      stbi_image_free);
  if (!image) {
    const char* const reason = stbi_failure_reason();
    throw InputError("no Radiance HDR that can be read (" + std::string(reason ? reason : "unknown") + ")");
  }
  RadianceImage radiance{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  radiance.pixels.resize(std::size_t{radiance.width} * radiance.height);
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  std::memcpy(radiance.pixels.data(), image.get(), radiance.pixels.size() * sizeof(glm::vec3));
  return radiance;
}

}  // namespace coppice
