#include "gpu/address_space.h"

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

#include "gpu/device.h"

namespace coppice {

void check_address_space([[maybe_unused]] std::uint64_t bytes, [[maybe_unused]] const std::string& beside) {
#if __has_include(<sys/mman.h>)
  void* const reserve = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (reserve == MAP_FAILED) {
    throw DeviceError("out of memory: " + beside + "the host's address space has no " +
                      std::to_string(bytes) + " bytes left for the driver");
  }
  munmap(reserve, bytes);
#endif
}

}  // namespace coppice
