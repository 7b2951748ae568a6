#include "scene/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

std::string last_error() { return std::strerror(errno); }

// Of a link that leads nowhere yet, where it leads; else the path itself.
std::filesystem::path follow(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path end = path;
  for (int links = 0; std::filesystem::is_symlink(end, error); ++links) {
    if (links == 40) fail_to_write(path, "too many links lead from one to another");
    end = end.parent_path() / std::filesystem::read_symlink(end, error);
  }
  return end;
}

// Other machines that share the folder may have a process of the same number.
const std::string& process_word() {
  static const std::string word = std::to_string(getpid()) + "-" + std::to_string(std::random_device{}());
  return word;
}

// Where the bytes go. A device or a pipe is written in place: renaming a file over it would replace it.
struct Target {
  std::filesystem::path path;     // links followed
  std::filesystem::path partial;  // what is written first; equal to path for what is no regular file
};

Target find_target(const std::filesystem::path& path) {
  if (path.empty()) throw InputError("cannot write: no file name given");
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail_to_write(path, "is a directory");
  Target target{path, path};
  if (std::filesystem::exists(status)) {
    if (access(path.c_str(), W_OK) != 0) fail_to_write(path, last_error());
    target.path = std::filesystem::canonical(path, error);
    if (error) fail_to_write(path, error.message());
    target.partial = target.path;
    if (!std::filesystem::is_regular_file(status)) return target;
  } else {
    target.path = target.partial = follow(path);
    if (const auto folder = target.path.parent_path(); !folder.empty()) {
      if (!std::filesystem::is_directory(folder, error)) fail_to_write(path, "no such directory");
    }
  }
  target.partial += "." + process_word() + ".partial";
  return target;
}

// Writes the bytes to the target or throws, leaving the target as it was.
void replace_file(const std::filesystem::path& path, const Target& target, std::string_view bytes) {
  std::error_code ignored;
  std::ofstream file(target.partial, std::ios::binary);
  if (!file) fail_to_write(path, last_error());
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  const bool in_place = target.partial == target.path;
  if (!file) {
    const std::string reason = last_error();
    if (!in_place) std::filesystem::remove(target.partial, ignored);
    fail_to_write(path, reason);
  }
  if (in_place) return;
  std::error_code error;
  std::filesystem::rename(target.partial, target.path, error);
  if (error) {
    std::filesystem::remove(target.partial, ignored);
    fail_to_write(path, error.message());
  }
}

}  // namespace

void fail_to_write(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(printable(path) + ": cannot write: " + reason);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  replace_file(path, find_target(path), bytes);
}

void check_writable(const std::filesystem::path& path) {
  const Target target = find_target(path);
  if (target.partial == target.path) return;
  const bool opened = std::ofstream(target.partial, std::ios::binary).is_open();
  const std::string reason = last_error();
  if (!opened) fail_to_write(path, reason);
  std::error_code ignored;
  std::filesystem::remove(target.partial, ignored);
}

}  // namespace coppice
