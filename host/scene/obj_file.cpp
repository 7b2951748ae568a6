#include "scene/obj_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

// A file that is open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

bool read_all(int descriptor, char* bytes, std::size_t size, std::size_t at) {
  while (size > 0) {
    const ssize_t count = pread(descriptor, bytes, size, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    at += static_cast<std::size_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

// In parallel, for most of the time goes into memory that is touched for the first time.
bool read_in_parallel(int descriptor, char* bytes, std::size_t size) {
  constexpr std::size_t block = std::size_t{4} << 20;
  std::atomic<bool> is_whole = true;
  tbb::parallel_for(std::size_t{0}, (size + block - 1) / block, [&](std::size_t i) {
    const std::size_t begin = i * block;
    if (!read_all(descriptor, bytes + begin, std::min(block, size - begin), begin)) is_whole = false;
  });
  return is_whole;
}

}  // namespace

ObjFile read_obj_file(const std::filesystem::path& path) {
  const std::string name = printable(path);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(name + ": is a directory, not an OBJ file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": not a regular file");

  // What was opened counts: the file may have become another one.
  const OpenFile file(path);
  struct stat opened {};
  if (!file.is_open() || fstat(file.descriptor(), &opened) != 0) {
    throw InputError(name + ": cannot open: " + std::strerror(errno));
  }
  if (!S_ISREG(opened.st_mode)) throw InputError(name + ": not a regular file");
  const auto size = static_cast<std::size_t>(opened.st_size);
  if (size == 0) throw InputError(name + ": empty file");
  try {
    ObjFile result(std::make_unique_for_overwrite<char[]>(size), size);
    if (!read_in_parallel(file.descriptor(), const_cast<char*>(result.text().data()), size)) {
      throw InputError(name + ": cannot read");
    }
    return result;
  } catch (const std::bad_alloc&) {
    throw InputError(name + ": no memory for its " + std::to_string(size) + " bytes");
  }
}

}  // namespace coppice
