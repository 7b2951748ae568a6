#include "interface/wide.h"

namespace coppice::twins {

void wide_sizes(const WideSizesArgs& args);

void wide_sizes_rest(const WideSizesRestArgs& args) {
  for (uint level = args.level_limit; level-- > args.level;)
    wide_sizes({args.entries, args.sizes, args.offsets, args.levels, level, 0});
}

}  // namespace coppice::twins
