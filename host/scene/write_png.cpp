#include "scene/write_png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <system_error>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(printable(path) + ": cannot write: " + reason);
}

std::string last_error() { return std::strerror(errno); }

// Where the bytes go. A device or a pipe is written in place: renaming a file over it would replace it.
struct Target {
  std::filesystem::path path;     // links followed
  std::filesystem::path partial;  // what is written first; equal to path for what is no regular file
};

Target find_target(const std::filesystem::path& path) {
  if (path.empty()) throw InputError("cannot write: no file name given");
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, "is a directory");
  Target target{path, path};
  if (std::filesystem::exists(status)) {
    if (access(path.c_str(), W_OK) != 0) fail(path, last_error());
    target.path = std::filesystem::canonical(path, error);
    if (error) fail(path, error.message());
    target.partial = target.path;
    if (!std::filesystem::is_regular_file(status)) return target;
  } else if (const auto folder = path.parent_path(); !folder.empty()) {
    if (!std::filesystem::is_directory(folder, error)) fail(path, "no such directory");
  }
  target.partial += "." + std::to_string(getpid()) + ".partial";
  return target;
}

// Writes the bytes to the target or throws, leaving the target as it was.
void replace_file(const std::filesystem::path& path, const Target& target, const unsigned char* bytes,
                  int size) {
  std::error_code ignored;
  std::ofstream file(target.partial, std::ios::binary);
  if (!file) fail(path, last_error());
  file.write(reinterpret_cast<const char*>(bytes), size);
  file.close();
  const bool in_place = target.partial == target.path;
  if (!file) {
    const std::string reason = last_error();
    if (!in_place) std::filesystem::remove(target.partial, ignored);
    fail(path, reason);
  }
  if (in_place) return;
  std::error_code error;
  std::filesystem::rename(target.partial, target.path, error);
  if (error) {
    std::filesystem::remove(target.partial, ignored);
    fail(path, error.message());
  }
}

}  // namespace

void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint32_t> rgba8) {
  const Target target = find_target(path);
  if (width == 0 || height == 0 || std::uint64_t{width} * height != rgba8.size()) {
    fail(path,
         std::to_string(width) + "x" + std::to_string(height) + " pixels are not what the picture holds");
  }
  // The encoder counts bytes in an int, a filter byte before each row included; compression may add a little.
  constexpr std::uint64_t limit = std::numeric_limits<int>::max() / 2;
  if ((std::uint64_t{width} * 4 + 1) * height > limit) {
    fail(path, std::to_string(width) + "x" + std::to_string(height) +
                   " pixels are more than a PNG writer here holds");
  }
  int size = 0;
  const auto columns = static_cast<int>(width), rows = static_cast<int>(height);
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(reinterpret_cast<const unsigned char*>(rgba8.data()), columns * 4, columns, rows,
                            4, &size),
      std::free);
  if (!png) fail(path, "out of memory");
  replace_file(path, target, png.get(), size);
}

void check_writable(const std::filesystem::path& path) {
  const Target target = find_target(path);
  if (target.partial == target.path) return;
  const bool opened = std::ofstream(target.partial, std::ios::binary).is_open();
  const std::string reason = last_error();
  if (!opened) fail(path, reason);
  std::error_code ignored;
  std::filesystem::remove(target.partial, ignored);
}

}  // namespace coppice
