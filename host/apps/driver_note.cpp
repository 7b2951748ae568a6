#include "apps/driver_note.h"

#include <cstdio>
#include <filesystem>

namespace coppice {

void note_slow_driver(const DeviceProperties& device) {
  if (device.loop_turn_limit == 0) return;  // not one of the old lavapipes
  // ./run.sh unpacks a newer one beside the program. It takes libraries of its own, so it must be named
  // before the program starts.
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path newer = program.parent_path() / "lavapipe";
  std::string remedy = "./run.sh fetches a newer one and runs on it";
  if (std::filesystem::exists(newer / "lvp_icd.json", error)) {
    remedy = "run it by ./run.sh, or with VK_DRIVER_FILES=" + (newer / "lvp_icd.json").string() +
             " LD_LIBRARY_PATH=" + (newer / "lib").string();
  }
  std::fprintf(stderr, "note: lavapipe of %s is 4 to 15 times slower than that of Mesa 25: %s\n",
               device.driver.c_str(), remedy.c_str());
}

}  // namespace coppice
