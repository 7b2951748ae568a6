#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>

namespace coppice {

// Writes an OpenEXR file of `width` x `height` pixels, rows top to bottom: channels R, G and B of 32-bit
// float, linear, with the primaries of sRGB, bit for bit as they are given, compressed without loss (ZIP).
// `rgb` holds width * height pixels, both at least 1. Errors as those of write_file.
void write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const glm::vec3> rgb);

}  // namespace coppice
