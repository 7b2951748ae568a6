#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace coppice {

struct ReadPng {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> rgba8;  // empty where the file is no PNG
};

inline ReadPng read_png(const std::string& path) {
  int width = 0, height = 0, channels = 0;
  unsigned char* const bytes = stbi_load(path.c_str(), &width, &height, &channels, 4);
  if (!bytes) return {};
  ReadPng read{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  read.rgba8.resize(std::size_t{read.width} * read.height);
  std::memcpy(read.rgba8.data(), bytes, read.rgba8.size() * 4);
  stbi_image_free(bytes);
  return read;
}

}  // namespace coppice
