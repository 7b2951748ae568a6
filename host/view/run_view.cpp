#include "view/run_view.h"

#include "gpu/device.h"
#include "pipeline/interruption.h"
#include "view/viewer.h"

namespace coppice {

ViewReport run_view(const ViewRun& run, const Note& note) {
  const InterruptionGuard guard;  // from the beginning, as it takes a while until there is a window
  auto viewer = std::make_unique<Viewer>(run, note);
  try {
    return viewer->run();
  } catch (const DeviceHung&) {
    (void)viewer.release();  // to free it would wait for the device
    throw;
  }
}

}  // namespace coppice
