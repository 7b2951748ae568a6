#include "view/run_view.h"

#include "gpu/device.h"
#include "view/viewer.h"

namespace coppice {

ViewReport run_view(const ViewRun& run, const Note& note) {
  auto viewer = std::make_unique<Viewer>(run, note);
  try {
    return viewer->run();
  } catch (const DeviceHung&) {
    (void)viewer.release();  // to free it would wait for the device
    throw;
  }
}

}  // namespace coppice
