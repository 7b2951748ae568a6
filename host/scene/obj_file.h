#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace coppice {

// The bytes of a file.
class ObjFile {
 public:
  ObjFile(std::unique_ptr<char[]> bytes, std::size_t size) : bytes_(std::move(bytes)), size_(size) {}
  std::string_view text() const { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t size_;
};

inline constexpr std::size_t LONG_OBJ_BYTES = std::size_t{32} << 20;  // whose progress is shown

// The bytes of a file that may be an OBJ. Throws InputError as load_obj says, and where memory does not hold
// them.
ObjFile read_obj_file(const std::filesystem::path& path);

}  // namespace coppice
