#include "scene/write_png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

#include "scene/write_file.h"

namespace coppice {

void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint32_t> rgba8) {
  check_writable(path);
  if (width == 0 || height == 0 || std::uint64_t{width} * height != rgba8.size()) {
    fail_to_write(path, std::to_string(width) + "x" + std::to_string(height) +
                            " pixels are not what the picture holds");
  }
  // The encoder counts bytes in an int, a filter byte before each row included; compression may add a little.
  constexpr std::uint64_t limit = std::numeric_limits<int>::max() / 2;
  if ((std::uint64_t{width} * 4 + 1) * height > limit) {
    fail_to_write(path, std::to_string(width) + "x" + std::to_string(height) +
                            " pixels are more than a PNG writer here holds");
  }
  int size = 0;
  const auto columns = static_cast<int>(width), rows = static_cast<int>(height);
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(reinterpret_cast<const unsigned char*>(rgba8.data()), columns * 4, columns, rows,
                            4, &size),
      std::free);
  if (!png) fail_to_write(path, "out of memory");
  write_file(path, {reinterpret_cast<const char*>(png.get()), static_cast<std::size_t>(size)});
}

}  // namespace coppice
