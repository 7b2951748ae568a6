#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace coppice {

// Writes a PNG of `width` x `height` pixels, rows top to bottom, red in the low byte and alpha in the high
// byte of each. `rgba8` holds width * height pixels, both at least 1. The file appears whole or not at all:
// it is written beside its target and renamed. Throws InputError with path and reason, and leaves no partial
// file.
void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint32_t> rgba8);

// Throws InputError with path and reason if write_png could not put a file there: to be called before long
// work. Leaves nothing behind and an existing file untouched.
void check_writable(const std::filesystem::path& path);

}  // namespace coppice
