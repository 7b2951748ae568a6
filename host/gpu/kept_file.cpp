#include "gpu/kept_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace coppice {

namespace {

// Closes what was opened, whichever way the function is left.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

}  // namespace

KeptFile read_kept_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
  KeptFile kept;
  const Descriptor file{open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)};
  struct stat status;
  if (file.number < 0 || fstat(file.number, &status) != 0) {
    kept.found = errno != ENOENT && errno != ENOTDIR;
    if (kept.found) kept.refused = std::string("cannot be opened: ") + std::strerror(errno);
    return kept;
  }
  kept.found = true;
  if (!S_ISREG(status.st_mode)) {
    kept.refused = "is no regular file";
    return kept;
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > most_bytes) {
    kept.refused = "is larger than " + std::to_string(most_bytes) + " bytes";
    return kept;
  }
  kept.bytes.resize(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = read(file.number, kept.bytes.data() + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  kept.bytes.resize(done);
  return kept;
}

}  // namespace coppice
