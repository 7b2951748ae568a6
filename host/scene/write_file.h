#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace coppice {

// The file appears whole or not at all: it is written beside its target, links followed, and renamed. A
// device or a pipe is written in place. Throws InputError with path and reason, and leaves no partial file.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Throws InputError with path and reason if write_file could not put a file there: to be called before long
// work. Leaves nothing behind and an existing file untouched.
void check_writable(const std::filesystem::path& path);

// Throws InputError with path and reason.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& reason);

}  // namespace coppice
