#include "twins/refit_box.h"

namespace coppice::twins {

void refit_appeared(const RefitAppearedArgs& args) {
  const uint count = absent_limit(args.state[0], args.triangle_count);
  for (uint i = 0; i < count; ++i) {
    if ((args.absent[i / 32] >> i % 32 & 1) != 0 && is_active(args.triangles[i]))
      ++args.refit[0].appeared_count;
  }
}

}  // namespace coppice::twins
