#include "view/run_view.h"

#include "view/viewer.h"

namespace coppice {

ViewReport run_view(const ViewRun& run, const Note& note) { return Viewer(run, note).run(); }

}  // namespace coppice
