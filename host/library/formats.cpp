// The public types are those of the kernels.
#include <cstddef>

#include "coppice/types.h"
#include "interface/batch.h"
#include "interface/refit.h"
#include "interface/trace.h"

namespace coppice {

#define SAME_PLACE(Public, public_member, Kernel, kernel_member) \
  static_assert(offsetof(Public, public_member) == offsetof(Kernel, kernel_member))

static_assert(sizeof(CoppiceTriangle) == sizeof(Triangle) && sizeof(CoppiceBox) == sizeof(Aabb) &&
              sizeof(CoppiceNode) == sizeof(Node) && sizeof(CoppiceWideNode) == sizeof(WideNode) &&
              sizeof(CoppiceRay) == sizeof(Ray) && sizeof(CoppiceHit) == sizeof(Hit) &&
              sizeof(CoppiceCandidate) == sizeof(BoxCandidate) &&
              sizeof(CoppiceRange) == sizeof(BatchRange) && sizeof(CoppiceBatchTree) == sizeof(BatchTree) &&
              sizeof(CoppiceTreeState) == sizeof(BuildState) &&
              sizeof(CoppiceRefitState) == sizeof(RefitState));
SAME_PLACE(CoppiceNode, child, Node, child);
SAME_PLACE(CoppiceNode, height, Node, height);
SAME_PLACE(CoppiceWideNode, exponents, WideNode, exponents);
SAME_PLACE(CoppiceWideNode, planes, WideNode, planes);
SAME_PLACE(CoppiceWideNode, child, WideNode, child);
SAME_PLACE(CoppiceRay, t_min, Ray, t_min);
SAME_PLACE(CoppiceRay, t_max, Ray, t_max);
SAME_PLACE(CoppiceHit, primitive, Hit, triangle);
SAME_PLACE(CoppiceHit, u, Hit, u);
SAME_PLACE(CoppiceCandidate, t_enter, BoxCandidate, t_enter);
SAME_PLACE(CoppiceBatchTree, error_word, BatchTree, error_word);
SAME_PLACE(CoppiceTreeState, active_count, BuildState, active_count);
SAME_PLACE(CoppiceTreeState, round_count, BuildState, round_count);
SAME_PLACE(CoppiceTreeState, error_word, BuildState, error_word);
SAME_PLACE(CoppiceTreeState, primitive_count, BuildState, primitive_count);

#undef SAME_PLACE

static_assert(COPPICE_WIDE_LEAF == WIDE_LEAF && COPPICE_WIDE_EMPTY == WIDE_EMPTY &&
              COPPICE_NO_PRIMITIVE == NO_TRIANGLE && COPPICE_PRIMITIVE_NOT_OPAQUE == PRIMITIVE_NOT_OPAQUE &&
              COPPICE_BATCH_MAX_PRIMITIVES == BATCH_MAX_PRIMITIVES);
static_assert(COPPICE_ERROR_REFIT_TOO_DEEP == ERROR_REFIT_TOO_DEEP);
static_assert(COPPICE_ERROR_SORT_LOOKBACK == ERROR_SORT_LOOKBACK &&
              COPPICE_ERROR_PLOC_LOOKBACK == ERROR_PLOC_LOOKBACK &&
              COPPICE_ERROR_PLOC_ROUNDS == ERROR_PLOC_ROUNDS &&
              COPPICE_ERROR_TREE_TOO_DEEP == ERROR_TREE_TOO_DEEP &&
              COPPICE_ERROR_TRACE_STEPS == ERROR_TRACE_STEPS &&
              COPPICE_ERROR_SCAN_LOOKBACK == ERROR_SCAN_LOOKBACK &&
              COPPICE_ERROR_WIDE_TOO_DEEP == ERROR_WIDE_TOO_DEEP && COPPICE_ERROR_COUNT == ERROR_COUNT &&
              COPPICE_ERROR_BATCH_RANGE == ERROR_BATCH_RANGE && COPPICE_ERROR_RAY_COUNT == ERROR_RAY_COUNT);

}  // namespace coppice
