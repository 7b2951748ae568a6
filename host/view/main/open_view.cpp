#include "apps/open_view.h"

namespace coppice {

ViewReport open_view(const ViewRun& run, const Note& note) { return run_view(run, note); }

}  // namespace coppice
