#include "render/moving_tree.h"

namespace coppice {

void append_moving_tree(Chain& chain, const MovingVertices& vertices, const FramePlan& plan,
                        const RefitPlan* refit, bool rebuilds) {
  const VertexTriangles triangles = triangles_of(chain, vertices);
  if (rebuilds) {
    append_build(chain, *plan.build, {triangles, {}});
    if (refit) append_refit_order(chain, plan.tree, *refit);
  } else {
    append_triangles(chain, plan.tree.triangles, triangles);
    append_refit(chain, plan.tree, *refit);
  }
}

void append_moving_wide(Chain& chain, const FramePlan& plan, bool rebuilds) {
  if (!plan.wide) return;
  if (rebuilds) {
    append_wide(chain, plan.tree, *plan.wide);
  } else {
    append_wide_boxes(chain, plan.tree, *plan.wide);
  }
}

}  // namespace coppice
