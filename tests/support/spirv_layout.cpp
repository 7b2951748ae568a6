#include "support/spirv_layout.h"

#include <cstring>

namespace coppice {

namespace {

constexpr std::uint32_t op_name = 5, op_type_runtime_array = 29, op_decorate = 71, op_member_decorate = 72;
constexpr std::uint32_t decoration_array_stride = 6, decoration_offset = 35;

}  // namespace

std::map<std::string, StructLayout> struct_layouts(std::span<const std::uint32_t> spirv) {
  std::map<std::uint32_t, std::string> names;
  std::map<std::uint32_t, std::vector<std::uint32_t>> offsets;
  std::map<std::uint32_t, std::uint32_t> strides, elements;
  for (std::size_t i = 5; i < spirv.size(); i += spirv[i] >> 16) {
    const std::uint32_t* const words = &spirv[i];
    switch (words[0] & 0xffff) {
      case op_name:
        names[words[1]] = reinterpret_cast<const char*>(words + 2);
        break;
      case op_member_decorate:
        if (words[3] != decoration_offset) break;
        offsets[words[1]].resize(std::max<std::size_t>(offsets[words[1]].size(), words[2] + 1));
        offsets[words[1]][words[2]] = words[4];
        break;
      case op_decorate:
        if (words[2] == decoration_array_stride) strides[words[1]] = words[3];
        break;
      case op_type_runtime_array:
        elements[words[1]] = words[2];
        break;
    }
  }
  std::map<std::string, StructLayout> layouts;
  for (const auto& [id, members] : offsets) layouts[names[id]].offsets = members;
  for (const auto& [array, element] : elements) {
    if (offsets.contains(element)) layouts[names[element]].array_stride = strides[array];
  }
  return layouts;
}

}  // namespace coppice
