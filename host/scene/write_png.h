#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace coppice {

// Writes a PNG of `width` x `height` pixels, rows top to bottom, red in the low byte and alpha in the high
// byte of each. `rgba8` holds width * height pixels, both at least 1. Errors as those of write_file.
void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint32_t> rgba8);

}  // namespace coppice
