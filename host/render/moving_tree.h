#pragma once

#include "pipeline/refit.h"
#include "render/frame.h"
#include "render/moving_vertices.h"

namespace coppice {

// From the vertices of a frame to its triangles and their tree: built, or with the boxes of the last build's
// refitted. `refit`: null where no frame is.
void append_moving_tree(Chain& chain, const MovingVertices& vertices, const FramePlan& plan,
                        const RefitPlan* refit, bool rebuilds);

// Then to its wide nodes, where it has any.
void append_moving_wide(Chain& chain, const FramePlan& plan, bool rebuilds);

}  // namespace coppice
