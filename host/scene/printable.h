#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace coppice {

// Text from outside, made fit for a message of one line: cut to 60 bytes, with every control character as
// '?'.
inline std::string printable(std::string_view text) {
  constexpr std::size_t limit = 60;
  std::string result{text.substr(0, limit)};
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > limit) result += "...";
  return result;
}

// A path in full, on one line.
inline std::string printable(const std::filesystem::path& path) {
  std::string result = path.string();
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return result;
}

}  // namespace coppice
