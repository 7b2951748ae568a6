// The reader of scene files under libFuzzer; see docs/testing.md.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/scene_inputs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string complaint =
      coppice::complaint_about_scene_file({reinterpret_cast<const char*>(bytes), size});
  if (!complaint.empty()) {
    std::fprintf(stderr, "complaint: %s\n", complaint.c_str());
    std::abort();
  }
  return 0;
}
