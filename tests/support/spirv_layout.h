#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace coppice {

// How a kernel lays out its structs: member offsets by struct name, and the stride of arrays of it (0 without
// one).
struct StructLayout {
  std::vector<std::uint32_t> offsets;
  std::uint32_t array_stride = 0;
};

std::map<std::string, StructLayout> struct_layouts(std::span<const std::uint32_t> spirv);

}  // namespace coppice
