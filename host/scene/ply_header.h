#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t ply_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t end = 0;    // where the data begin
  std::size_t lines = 0;  // before them
};

// Throws InputError "NAME:LINE: ...". Each element has as many bytes in the text as its count needs at least.
PlyHeader read_ply_header(std::string_view text, const std::string& name);

}  // namespace coppice
