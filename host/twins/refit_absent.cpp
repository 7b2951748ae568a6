#include <algorithm>

#include "twins/refit_box.h"

namespace coppice::twins {

uint absent_limit(const BuildState& state, uint triangle_count) {
  const uint count = std::min(state.primitive_count, triangle_count);
  return state.active_count < count ? count : 0;
}

void refit_absent(const RefitAbsentArgs& args) {
  const uint count = absent_limit(args.state[0], args.triangle_count);
  for (uint i = 0; i < count; ++i) {
    if (i % 32 == 0) args.absent[i / 32] = 0;
    if (!is_active(args.triangles[i])) args.absent[i / 32] |= 1u << i % 32;
  }
}

}  // namespace coppice::twins
