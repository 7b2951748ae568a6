#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace coppice {

// What a file of the cache holds, or why not.
struct KeptFile {
  bool found = false;   // there is something of that name
  std::string bytes;    // empty unless it was read whole
  std::string refused;  // why it was not: no regular file, too large, not to be opened
};

// Reads a regular file of at most `most_bytes`. Whatever else bears the name is not waited for: a pipe
// without a writer, a device without an end.
KeptFile read_kept_file(const std::filesystem::path& path, std::uint64_t most_bytes);

}  // namespace coppice
