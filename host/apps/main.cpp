#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include <cstdio>
#include <exception>
#include <limits>
#include <new>

#include "apps/command_line.h"
#include "apps/progress.h"

int main(int argc, char** argv) {
  // Memory that one build gives back serves the next: fetching it from the kernel anew, page by page, takes
  // up to half of a build of a million triangles.
#ifdef M_MMAP_MAX
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
  try {
    coppice::show_loading();
    return coppice::run_command_line(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "coppice: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "coppice: %s\n", error.what());
  }
  return 1;
}
