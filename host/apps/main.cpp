#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "apps/command_line.h"
#include "apps/heap.h"
#include "gpu/device.h"
#include "measure/progress.h"
#include "pipeline/interruption.h"
#include "pipeline/loose_thread.h"

namespace {

// A standard stream that the caller closed would be the first file that the program opens. What is written to
// these stand-ins fails as it would on a closed stream.
void hold_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", O_RDONLY);
  }
}

// What was printed may still lie in the buffer, or have failed unseen: a full disk, say, where stdout goes.
int status_after_output(int status) {
  errno = 0;
  const bool written = std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (written || status != 0) return status;
  std::fprintf(stderr, "coppice: cannot write to stdout%s%s\n", errno ? ": " : "",
               errno ? std::strerror(errno) : "");
  return 1;
}

int status_of_command(int argc, char** argv) {
  try {
    coppice::show_loading();
    return status_after_output(coppice::run_command_line(argc, argv));
  } catch (const coppice::Interrupted& interrupted) {
    std::fprintf(stderr, "coppice: interrupted\n");
    return 128 + interrupted.signal;  // as shells say it
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "coppice: out of memory\n");
  } catch (const coppice::NoSuchDevice& error) {
    std::fprintf(stderr, "coppice: --device: %s (see 'coppice devices')\n", error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "coppice: %s\n", error.what());
  }
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  hold_closed_streams();
  coppice::settle_heap();
  const int status = status_of_command(argc, argv);
  if (!coppice::has_loose_threads()) return status;
  std::fflush(nullptr);
  _exit(status);
}
