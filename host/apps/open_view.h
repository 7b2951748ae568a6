#pragma once

#include "view/run_view.h"

namespace coppice {

// What `coppice view` does: run_view in the program that has a window, coppice-view. The other one, which
// needs neither a display's libraries nor Vulkan's to start, becomes that program (open_view.cpp).
ViewReport open_view(const ViewRun& run, const Note& note);

}  // namespace coppice
